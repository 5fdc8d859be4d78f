use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Lambert(Vec3);

fn main() {}
