// I002, I003: `pipeline!` knows what a callable takes

use optix_device_rs::prelude::*;

#[direct_callable]
fn wood<P: Pipeline, T>(_: &DirectCallable<P>, of: T) -> T {
    of
}

fn main() {}
