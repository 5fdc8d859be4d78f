// C039, C041: a bound value has the type of its field, and only fields with #[bound] have one

use optix_device_rs::prelude::*;

use optix_device_rs::params::Bound;

#[launch_params]
pub struct Frame {
    #[bound]
    pub max_bounces: u32,
    pub exposure: f32,
}

pub const ONE: Bound<Frame, f32> = Frame::MAX_BOUNCES;
pub const TWO: Bound<Frame, f32> = Frame::EXPOSURE;

fn main() {}
