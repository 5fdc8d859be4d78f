//! The raw OptiX 9.0 ABI (version 105) and what older versions change.
//!
//! Structures and constants keep their C names, so that NVIDIA's API reference can be searched for them. Their values,
//! sizes and offsets are facts of the ABI; every size, alignment and field offset is written next to the field and
//! checked at compile time. Values that come from the driver are integers in newtypes, never Rust enums, because a
//! newer driver may return values this file does not list.

#![allow(missing_docs, reason = "fields and constants have the meaning that the API reference gives to their C names")]

#[macro_use]
mod layout;

mod abi;
mod accel;
mod context;
mod module;
mod pipeline;
mod program;
mod result;
mod table;
mod transform;

pub use abi::{ABIS, Abi, negotiate};
pub use accel::*;
pub use context::*;
pub use module::*;
pub use pipeline::*;
pub use program::*;
pub use result::OptixResult;
pub use table::{FunctionTable, QueryFunctionTable};
pub use transform::*;

/// A CUDA device address, the same type as cudarc's.
pub type CUdeviceptr = cudarc::driver::sys::CUdeviceptr;
/// A CUDA context, the same type as cudarc's.
pub type CUcontext = cudarc::driver::sys::CUcontext;
/// A CUDA stream, the same type as cudarc's.
pub type CUstream = cudarc::driver::sys::CUstream;
/// The 64-bit name of a traversable, made by the driver. 0 is the null handle: a trace of it calls the miss program.
pub type OptixTraversableHandle = u64;

handles! {
    /// Owned by [`FunctionTable::device_context_create`].
    OptixDeviceContext;
    /// Owned by [`FunctionTable::module_create`] or [`FunctionTable::builtin_is_module_get`].
    OptixModule;
    /// Owned by [`FunctionTable::program_group_create`].
    OptixProgramGroup;
    /// Owned by [`FunctionTable::pipeline_create`].
    OptixPipeline;
}

/// Bytes of a shader-binding-table record header.
pub const OPTIX_SBT_RECORD_HEADER_SIZE: usize = crate::limits::RECORD_HEADER_SIZE;
/// Alignment in bytes of every shader-binding-table record, and so of every stride.
pub const OPTIX_SBT_RECORD_ALIGNMENT: usize = crate::limits::RECORD_ALIGNMENT;
/// Alignment in bytes of the output and temporary buffers of a build.
pub const OPTIX_ACCEL_BUFFER_BYTE_ALIGNMENT: u64 = 128;
/// Alignment in bytes of instances in device memory.
pub const OPTIX_INSTANCE_BYTE_ALIGNMENT: u64 = 16;
/// Alignment in bytes of axis-aligned boxes in device memory.
pub const OPTIX_AABB_BUFFER_BYTE_ALIGNMENT: u64 = 8;
/// Alignment in bytes of the 3x4 matrix that a triangle input is transformed by at build time.
pub const OPTIX_GEOMETRY_TRANSFORM_BYTE_ALIGNMENT: u64 = 16;
/// Alignment in bytes of a transform traversable in device memory.
pub const OPTIX_TRANSFORM_BYTE_ALIGNMENT: u64 = 64;
