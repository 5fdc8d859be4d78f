// T06: context and record are borrowed for the call

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Sky {
    pub zenith: Vec3,
}

#[miss]
pub fn sky<P: Pipeline>(_: &'static Miss<P>, record: &'static Sky) {
    let _ = record.zenith;
}

fn main() {}
