// I002, I003: a signature passes values

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Paint {
    pub texture: Callable<fn(&Vec2) -> Vec3>,
}

fn main() {}
