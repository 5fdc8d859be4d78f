// C020: an intersection program says what hits carry

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Attributes)]
pub struct BallHit {
    pub normal: Vec3,
}

#[intersection]
pub fn ball<P: Pipeline, A: Attributes>(_: &Intersection<P, A>) {}

fn main() {}
