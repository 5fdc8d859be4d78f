// T04: an element is aligned to 16 bytes at most

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Element)]
#[repr(C, align(64))]
pub struct Line(pub [u32; 16]);

fn main() {}
