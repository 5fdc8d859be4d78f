// T03, T04: what the crate calls `core` is not asked for sizes

extern crate core as real;
extern crate self as core;
pub use real::*;
pub mod mem {
    pub use real::mem::*;
    pub const fn size_of<T>() -> usize {
        5
    }
}

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Element)]
#[repr(C)]
pub struct Padded {
    pub flag: u8,
    pub number: u32,
}

fn main() {}
