// T04: a buffer has no bytes that belong to no field

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Element)]
#[repr(C)]
pub struct Vertex {
    pub flags: u8,
    pub position: Vec3,
    pub weight: f64,
}

fn main() {}
