// T05: a struct does not hide a view

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, DeviceData)]
#[repr(C)]
pub struct Texture {
    pub texels: Slice<Vec4>,
    pub width: u32,
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Lambert {
    pub albedo: Texture,
}

fn main() {}
