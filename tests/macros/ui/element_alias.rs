// T04: an alias does not make a bool an element

use optix_device_rs::prelude::*;

type Flag = bool;

#[derive(Clone, Copy, Element)]
#[repr(C)]
pub struct Vertex {
    pub hard: Flag,
}

fn main() {}
