// C034: launch parameters are read by name

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame(u32);

fn main() {}
