// T04: a buffer has no bytes that belong to no field

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Element)]
#[repr(C)]
pub struct Sample {
    pub weight: f64,
    pub position: Vec3,
}

#[derive(Clone, Copy, Element)]
#[repr(C)]
pub struct Pair(u8, u16);

fn main() {}
