// T01: bound takes no arguments

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    #[bound(8)]
    pub max_bounces: u32,
}

fn main() {}
