// D004, T05: a record borrows nothing

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Painted<'a> {
    pub texels: &'a [Vec4],
}

fn main() {}
