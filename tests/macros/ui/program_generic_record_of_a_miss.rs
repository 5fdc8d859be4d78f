// D009: a ray type has one miss record

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Sky {
    pub zenith: Vec3,
}

#[miss]
pub fn sky<P: Pipeline, R: SbtRecord>(_: &Miss<P>, record: &R) {
    let _ = record;
}

fn main() {}
