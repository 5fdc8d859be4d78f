// I016: a record holds no function pointer

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Paint {
    pub texture: fn(Vec2) -> Vec3,
}

fn main() {}
