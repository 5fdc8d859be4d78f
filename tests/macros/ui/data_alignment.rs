// T04: what a parameter or record holds is aligned to 16 bytes at most

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, DeviceData)]
#[repr(C, align(32))]
pub struct Wide {
    pub numbers: [f32; 8],
}

fn main() {}
