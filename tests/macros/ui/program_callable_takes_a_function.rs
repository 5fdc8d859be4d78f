// I016: a callable is passed no function pointer

use optix_device_rs::prelude::*;

#[direct_callable]
fn wood<P: Pipeline>(_: &DirectCallable<P>, uv: Vec2, noise: fn(Vec2) -> f32) -> f32 {
    noise(uv)
}

fn main() {}
