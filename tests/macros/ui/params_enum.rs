// C034: launch parameters are one struct

use optix_device_rs::prelude::*;

#[launch_params]
pub enum Frame {
    Small,
    Large,
}

fn main() {}
