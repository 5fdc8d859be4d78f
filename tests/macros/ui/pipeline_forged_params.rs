// C034, C041: only launch_params says where the fields are

use optix_device_rs::params::{Field, LaunchParams};
use optix_device_rs::prelude::*;

#[derive(Clone, Copy, DeviceData)]
#[repr(C)]
pub struct Mine {
    pub count: u32,
}

impl LaunchParams for Mine {
    const NAME: &'static str = "Mine";
    const SYMBOL: &'static str = "mine";
    const FIELDS: &'static [Field] = &[];
    type View<'a> = &'a Mine;
    type Host = Mine;
}

fn main() {}
