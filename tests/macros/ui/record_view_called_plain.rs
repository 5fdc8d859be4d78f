// T05: nobody says that a struct hides no view

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, DeviceData)]
#[repr(C)]
pub struct Hidden {
    pub data: SliceMut<u32>,
}
impl optix_device_rs::data::Plain for Hidden {}

#[launch_params]
pub struct Frame {
    pub hidden: Hidden,
}

fn main() {}
