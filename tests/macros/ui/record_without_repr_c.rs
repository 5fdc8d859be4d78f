// T04: host and device agree on the layout

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
pub struct Lambert {
    pub albedo: Vec3,
}

fn main() {}
