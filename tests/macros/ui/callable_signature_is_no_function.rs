// I002: a reference names a signature

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Paint {
    pub texture: Callable<Vec3>,
}

fn main() {}
