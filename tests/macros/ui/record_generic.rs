// D004, D009: a record has one layout

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Lambert<T> {
    pub albedo: T,
}

fn main() {}
