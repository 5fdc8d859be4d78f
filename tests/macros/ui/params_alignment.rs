// T04: launch parameters are aligned to 16 bytes at most

use optix_device_rs::prelude::*;

#[launch_params]
#[repr(C, align(64))]
pub struct Frame {
    pub bounces: u32,
}

fn main() {}
