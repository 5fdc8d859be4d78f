// I002: arguments of a callable travel in registers

use optix_device_rs::prelude::*;

pub struct Noise {
    pub scale: f32,
}

#[direct_callable]
fn wood<P: Pipeline>(_: &DirectCallable<P>, uv: Vec2, noise: Noise) -> Vec2 {
    uv * noise.scale
}

fn main() {}
