// T04: fields are where programs can load them

use optix_device_rs::prelude::*;

#[launch_params]
#[repr(C, packed)]
pub struct Frame {
    pub value: u32,
}

fn main() {}
