// T05, D001: an application fills in every field of a record

use optix_device_rs::host::Buffer;
use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Painted {
    pub texels: Slice<Vec4>,
    pub scale: f32,
}

pub fn paint(texels: Buffer<Vec4>) -> PaintedHost {
    PaintedHost { texels }
}

fn main() {}
