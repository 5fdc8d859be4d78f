// C001, C013, I011: a callable has its kind's context

use optix_device_rs::prelude::*;

#[direct_callable]
fn wood<P: Pipeline>(_: &ContinuationCallable<P>) -> f32 {
    1.0
}

fn main() {}
