// T04: programs read fields by reference

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C, packed)]
pub struct Lambert {
    pub albedo: Vec3,
}

fn main() {}
