// T05: plain data is no view

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Lambert {
    #[view]
    pub albedo: Vec3,
}

fn main() {}
