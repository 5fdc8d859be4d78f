//! What a machine is given to build acceleration structures, and what it gives back.

use super::{GeometryData, InstanceFlags};
use optix_device_rs::host::GeometryKind;
use std::any::Any;
use std::sync::Arc;

/// The build inputs of a GAS.
pub(crate) struct GasInput {
    pub kind: GeometryKind,
    pub inputs: Vec<BuildInput>,
    pub compact: bool,
    /// Whether programs read its vertices by handle.
    pub random_vertex_access: bool,
}

/// One build input: a geometry with its records.
pub(crate) struct BuildInput {
    pub geometry: Arc<GeometryData>,
    /// Per record: whether any of its programs has an any-hit.
    pub record_has_anyhit: Vec<bool>,
    /// Per primitive: its record; none with a single record.
    pub record_of_primitive: Option<Vec<u32>>,
}

/// What an IAS is built of.
pub(crate) struct IasInput {
    pub instances: Vec<InstanceInput>,
    /// Whether programs read its instances by handle.
    pub random_instance_access: bool,
}

/// An instance of an acceleration structure.
pub(crate) struct InstanceInput {
    pub transform: [f32; 12],
    pub id: u32,
    pub mask: u8,
    pub flags: InstanceFlags,
    pub sbt_offset: u32,
    pub child: BuiltAccel,
}

/// An acceleration structure: `owner` keeps `handle` alive.
#[derive(Clone)]
pub(crate) struct BuiltAccel {
    pub handle: u64,
    pub owner: Arc<dyn Any + Send + Sync>,
    /// Bytes of the finished structure.
    pub bytes: usize,
}
