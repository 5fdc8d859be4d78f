use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Attributes)]
pub struct BallHit {
    pub normal: Option<Vec3>,
}

fn main() {}
