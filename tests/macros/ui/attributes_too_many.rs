// G031, C020: a hit carries eight words at most

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Attributes)]
pub struct BallHit {
    pub normal: Vec3,
    pub tangents: [Vec3; 2],
}

fn main() {}
