// T01: launch_params stands above derives

use optix_device_rs::prelude::*;

#[derive(Clone, Copy)]
#[launch_params]
pub struct Frame {
    pub count: u32,
}

fn main() {}
