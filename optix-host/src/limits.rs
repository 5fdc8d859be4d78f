//! Limits of OptiX that the host checks, on either machine. Those of a GPU are asked from its driver
//! ([`Limits`](crate::optix::driver::Limits)); those that concern programs are the device crate's.

pub use optix_device_rs::limits::*;

/// The most structures on a way from the root of a graph to a primitive, the GAS included (guide 12).
pub const MAX_GRAPH_DEPTH: usize = 31;
/// The most primitives of a GAS, over all build inputs (guide 12).
pub const MAX_PRIMITIVES: usize = 1 << 29;
/// The most hit-group records that one GAS refers to (guide 12).
pub const MAX_RECORDS_OF_GAS: usize = 1 << 24;
/// The most instances of an IAS (guide 12).
pub const MAX_INSTANCES: usize = 1 << 28;
/// The bits of an instance's id, and of a record offset and the sum of those on a way down a graph (guide 5.4, 12).
pub const INSTANCE_BITS: u32 = 28;
/// The greatest id of an instance, and the greatest record offset: see [`INSTANCE_BITS`].
pub const MAX_INSTANCE_NUMBER: u32 = (1 << INSTANCE_BITS) - 1;
/// The most launch indices of a launch (guide 12).
pub const MAX_LAUNCH_SIZE: u64 = 1 << 30;
/// Bytes of a record's header, `OPTIX_SBT_RECORD_HEADER_SIZE` (guide 7.2).
pub const RECORD_HEADER_SIZE: usize = 32;
/// What addresses and strides of records are multiples of, `OPTIX_SBT_RECORD_ALIGNMENT` (guide 7.2).
pub const RECORD_ALIGNMENT: usize = 16;
