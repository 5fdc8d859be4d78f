// T03, T05: a field is taken for a view by its type's name

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, DeviceData)]
#[repr(C)]
pub struct Slice {
    pub first: u32,
    pub count: u32,
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Mesh {
    pub triangles: Slice,
}

fn main() {}
