// D003: a record is aligned to 16 bytes at most

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C, align(32))]
pub struct Lambert {
    pub albedo: Vec3,
}

fn main() {}
