// T06, D009: who may name a program may name its record

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
struct Sky {
    zenith: Vec3,
}

#[miss]
pub fn sky<P: Pipeline>(_: &Miss<P>, record: &Sky) {
    let _ = record.zenith;
}

fn main() {}
