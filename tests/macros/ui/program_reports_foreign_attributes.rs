// G029, C020: an intersection program reports its own attributes

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Attributes)]
pub struct BallHit {
    pub normal: Vec3,
}

#[intersection]
pub fn ball<P: Pipeline>(isect: &Intersection<P, BallHit>) {
    isect.report(1.0, 0, Triangles { u: 0.0, v: 0.0 });
}

fn main() {}
