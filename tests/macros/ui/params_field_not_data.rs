use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub count: usize,
}

fn main() {}
