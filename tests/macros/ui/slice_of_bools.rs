// T04: a buffer holds elements only

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Mask {
    pub bits: Slice<bool>,
}

fn main() {}
