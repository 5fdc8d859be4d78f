// I002, I012: arguments of a callable are passed by value

use optix_device_rs::prelude::*;

#[direct_callable]
fn wood<P: Pipeline>(_: &DirectCallable<P>, uv: Vec2, at: &Vec3) -> Vec3 {
    uv.extend(at.z)
}

fn main() {}
