// D004, T04: a record is plain data

use optix_device_rs::prelude::*;

#[derive(Clone, Copy)]
pub struct Colour(f32, f32, f32);

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Lambert {
    pub albedo: Colour,
    pub name: &'static str,
}

fn main() {}
