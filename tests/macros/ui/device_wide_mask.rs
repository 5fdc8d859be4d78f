// G006: a visibility mask has eight bits

use optix_device_rs::prelude::*;

pub fn ray() -> Ray {
    Ray::new(Vec3::ZERO, Vec3::X).mask(0x100)
}

fn main() {}
