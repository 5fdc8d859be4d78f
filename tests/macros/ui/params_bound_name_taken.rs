// C039: a bound field has a constant of its name

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    #[bound]
    pub max_bounces: u32,
}

impl Frame {
    pub const MAX_BOUNCES: u32 = 8;
}

fn main() {}
