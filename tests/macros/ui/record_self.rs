// T03: Self means another type in what the derive makes

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Node {
    pub children: Slice<Self>,
}

fn main() {}
