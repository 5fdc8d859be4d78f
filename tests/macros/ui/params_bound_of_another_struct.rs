// C039, C041: a bound value is of its own struct

use optix_device_rs::params::Bound;
use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    #[bound]
    pub depth: u32,
}

#[launch_params]
pub struct Other {
    #[bound]
    pub depth: u32,
}

pub const DEPTH: Bound<Frame, u32> = Other::DEPTH;

fn main() {}
