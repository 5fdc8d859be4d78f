// D004: a record is copied to the device

use optix_device_rs::prelude::*;

#[derive(SbtRecord)]
#[repr(C)]
pub struct Lambert {
    pub albedo: Vec3,
}

fn main() {}
