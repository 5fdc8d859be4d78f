// T01, D009: a program has the same arguments on host and device

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Sky {
    pub zenith: Vec3,
}

#[miss]
pub fn sky<P: Pipeline>(_: &Miss<P>, #[cfg(not(target_arch = "nvptx64"))] record: &Sky) {
    let _ = record.zenith;
}

fn main() {}
