// T05, D009: a view shows a buffer of its own elements

use optix_device_rs::host::Buffer;
use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Painted {
    pub texels: Slice<Vec4>,
}

pub fn paint(texels: Buffer<Vec3>) -> PaintedHost {
    PaintedHost { texels }
}

fn main() {}
