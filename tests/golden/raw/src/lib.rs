//! The programs of `golden-typed-shaders` as one would write them with nothing but the intrinsics: names, offsets, indices,
//! types and counts by hand.
#![no_std]

#[cfg(target_arch = "nvptx64")]
mod intrinsics;
#[cfg(target_arch = "nvptx64")]
mod programs;
