// T04: any bytes of a buffer are a value of its elements

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Element)]
#[repr(C)]
pub struct Vertex {
    pub visible: bool,
    pub indices: Slice<u32>,
}

fn main() {}
