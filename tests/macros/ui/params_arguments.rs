// T01: an attribute takes no arguments it does not know

use optix_device_rs::prelude::*;

#[launch_params(symbol = "params")]
pub struct Frame {
    pub count: u32,
}

fn main() {}
