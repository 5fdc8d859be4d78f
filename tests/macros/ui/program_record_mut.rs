// D008: a record is read-only

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Lambert {
    pub albedo: Vec3,
}

#[miss]
pub fn sky<P: Pipeline>(_: &Miss<P>, record: &mut Lambert) {
    record.albedo = Vec3::ZERO;
}

fn main() {}
