//! Device programs whose launches are timed against programs of the same meaning in CUDA C++ (the folder `cuda` beside
//! this crate): with the path tracer of the examples, one for each kind of load that renderers put on a GPU.
//!
//! They use no function whose result the two languages' libraries may round differently, so without contraction the
//! pictures are the same to the bit.
#![no_std]

pub mod field;
pub mod foliage;
pub mod occlusion;
pub mod wide;

use optix_device_rs::prelude::*;

/// The middle of a pixel in the picture, both coordinates from 0 to 1.
fn middle(px: UVec2, size: UVec2) -> Vec2 {
    (px.as_vec2() + 0.5) / size.as_vec2()
}
