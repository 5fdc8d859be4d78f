// I002: a callable returns what is new

use optix_device_rs::prelude::*;

#[direct_callable]
fn wood<P: Pipeline>(_: &DirectCallable<P>, colour: &mut Vec3) {
    *colour = Vec3::X;
}

fn main() {}
