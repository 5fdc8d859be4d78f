// T04: a field has one size on host and device

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub count: usize,
}

fn main() {}
