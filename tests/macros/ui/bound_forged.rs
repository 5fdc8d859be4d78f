// C039, C041: a bound value is named by the parameters

use optix_device_rs::prelude::*;
use optix_device_rs::params::{Bound, Field};

#[launch_params]
pub struct Frame {
    #[bound]
    pub bounces: u32,
}

pub const ELSEWHERE: Bound<Frame, u32> = Bound::new(Field { name: "bounces", offset: 4000, size: 4, bound: true, slice: false });

fn main() {}
