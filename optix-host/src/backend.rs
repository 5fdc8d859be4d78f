//! What a machine does for the host: memory, acceleration structures, pipelines. The CPU executor and the OptiX driver
//! implement it and do not know each other.

use crate::Result;
use crate::plan::Plan;
use crate::sbt::ShaderBindingTable;
use crate::scene::{GeometryData, InstanceFlags};
use optix_device_rs::host::{DeviceId, GeometryKind, Kept, Memory};
use std::any::Any;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A machine.
pub(crate) trait Backend: Any + Send + Sync {
    /// Unique in the process.
    fn id(&self) -> DeviceId;
    /// Takes what the machine complained about since the last call.
    fn take_complaints(&self) -> Vec<String>;
    /// Allocates zeroed memory for elements that the CPU accesses `width` bytes at a time
    /// ([`shared::width`](optix_device_rs::host::shared::width)).
    fn allocate(&self, bytes: usize, width: usize) -> Result<Arc<dyn Memory>>;
    /// Builds a geometry acceleration structure.
    fn build_gas(&self, input: &GasInput) -> Result<BuiltAccel>;
    /// Builds an instance acceleration structure.
    fn build_ias(&self, input: &IasInput) -> Result<BuiltAccel>;
    /// By which number programs know callable record `index` of a scene; those of the `count` records from there on follow it.
    fn number_callables(&self, index: u32, count: u32) -> Result<u32>;
    /// Makes a pipeline ready to launch. `kept` is what the table's records point to, which the pipeline keeps.
    fn link(&self, plan: Arc<Plan>, sbt: ShaderBindingTable, kept: &[Kept]) -> Result<Box<dyn Linked>>;
}

/// A pipeline that is ready to launch.
pub(crate) trait Linked: Send {
    /// Begins a launch; `params` are the bytes of the parameter struct, and `kept` is what they point to, which the launch keeps.
    fn launch(&self, raygen: usize, params: &[u8], kept: &[Kept], dimensions: [u32; 3]) -> Result<Box<dyn Running>>;
    /// What the machine says of the pipeline: sizes, registers, log.
    fn details(&self) -> Vec<String>;
}

/// A launch under way.
pub(crate) trait Running: Send {
    /// Waits until it is done.
    fn wait(&mut self) -> Result<()>;
}

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

/// A device id that was not given before.
pub(crate) fn next_device_id() -> DeviceId {
    static NEXT: AtomicU64 = AtomicU64::new(1);
    DeviceId(NEXT.fetch_add(1, Ordering::Relaxed))
}
