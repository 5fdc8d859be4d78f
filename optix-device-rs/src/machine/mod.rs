//! The machine a program runs on: OptiX intrinsics on the device, the executor's frame on the host.
//!
//! [`Cx`] has the same methods on both, so that everything above this module has one body.

#[cfg(target_arch = "nvptx64")]
mod ptx;
#[cfg(target_arch = "nvptx64")]
pub use ptx::{
    Cx, ParamsBase, UNWRITTEN, approximate, check, is_back_face, load_param, place, place_if, primitive_type_of, trap,
    unwritten, wide,
};

#[cfg(not(target_arch = "nvptx64"))]
mod host;
#[cfg(not(target_arch = "nvptx64"))]
pub use host::{
    Cx, ParamsBase, UNWRITTEN, check, is_back_face, load_param, place, place_if, primitive_type_of, unwritten, wide,
};

/// The arguments of a trace call but for the payload, all derived from the ray and the ray type.
#[derive(Clone, Copy, Debug)]
pub struct TraceCall {
    pub payload_type: u32,
    /// Registers.
    pub payload_words: usize,
    pub traversable: u64,
    pub ray: crate::ray::Ray,
    pub sbt_offset: u32,
    pub sbt_stride: u32,
    pub miss_index: u32,
    /// Fields of the payload that the caller gives, and those that it takes back. For the executor's checks; the device has
    /// them in the payload type.
    pub caller_writes: &'static [usize],
    pub caller_reads: &'static [usize],
}
