// T05: an alias does not hide a view

use optix_device_rs::prelude::*;

type Texture = Slice<Vec4>;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Lambert {
    pub albedo: Vec3,
    pub texture: Texture,
}

fn main() {}
