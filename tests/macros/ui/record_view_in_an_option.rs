// T05: an option has no layout, and hides no view

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Painted {
    pub texture: Option<Slice<Vec4>>,
}

fn main() {}
