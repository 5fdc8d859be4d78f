// T04: host and device agree on the layout

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, DeviceData)]
pub struct Pinhole {
    pub eye: Vec3,
}

fn main() {}
