// T05: an alias of an array does not hide views

use optix_device_rs::prelude::*;

type Textures<const N: usize> = [Slice<Vec4>; N];

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Painted {
    pub textures: Textures<2>,
}

fn main() {}
