// T05: a tuple has no layout, and hides no view

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Painted {
    pub texture: (Slice<Vec4>, u32),
}

fn main() {}
