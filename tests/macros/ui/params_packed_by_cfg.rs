// T04: packing behind cfg_attr is found too

use optix_device_rs::prelude::*;

#[launch_params]
#[cfg_attr(target_pointer_width = "64", repr(packed))]
pub struct Frame {
    pub flag: u8,
    pub count: u32,
}

fn main() {}
