// G030, G006: a hit kind is a byte

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Attributes)]
pub struct BallHit {
    pub normal: Vec3,
}

#[intersection]
pub fn ball<P: Pipeline>(isect: &Intersection<P, BallHit>) {
    isect.report(1.0, 0x100, BallHit { normal: Vec3::X });
}

fn main() {}
