//! What a machine does for the host: memory, acceleration structures, pipelines. The CPU executor and the OptiX driver
//! implement it and do not know each other.

use crate::Result;
use crate::plan::Plan;
use crate::sbt::ShaderBindingTable;
use crate::scene::{BuiltAccel, GasInput, IasInput};
use crate::texture::TextureInput;
use optix_device_rs::host::{DeviceId, Kept, Memory, TextureMemory};
use std::any::Any;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A machine.
pub(crate) trait Backend: Any + Send + Sync {
    /// Unique in the process.
    fn id(&self) -> DeviceId;
    /// Takes the warnings and errors that the machine reported since the last call.
    fn take_messages(&self) -> Vec<String>;
    /// Allocates zeroed memory for elements that the CPU accesses `width` bytes at a time
    /// ([`shared::width`](optix_device_rs::host::shared::width)).
    fn allocate(&self, bytes: usize, width: usize) -> Result<Arc<dyn Memory>>;
    /// Makes a texture.
    fn create_texture(&self, input: &TextureInput<'_>) -> Result<Arc<dyn TextureMemory>>;
    /// Builds a geometry acceleration structure.
    fn build_gas(&self, input: &GasInput) -> Result<BuiltAccel>;
    /// Builds an instance acceleration structure.
    fn build_ias(&self, input: &IasInput) -> Result<BuiltAccel>;
    /// The number by which programs know callable record `index` of a scene. The numbers of the `count` records from
    /// there on follow it.
    fn number_callables(&self, index: u32, count: u32) -> Result<u32>;
    /// Makes a pipeline ready to launch. `kept` is what the table's records point to; the pipeline keeps it.
    fn link(&self, plan: Arc<Plan>, sbt: ShaderBindingTable, kept: &[Kept]) -> Result<Box<dyn Linked>>;
}

/// A pipeline that is ready to launch.
pub(crate) trait Linked: Send {
    /// Begins a launch. `params` are the bytes of the parameter struct. `kept` is what they point to; the launch keeps
    /// it.
    fn launch(&self, raygen: usize, params: &[u8], kept: &[Kept], dimensions: [u32; 3]) -> Result<Box<dyn Running>>;
    /// What the machine reports about the pipeline: sizes, registers, log.
    fn details(&self) -> Vec<String>;
}

/// A launch under way.
pub(crate) trait Running: Send {
    /// Waits until it is done.
    fn wait(&mut self) -> Result<()>;
}

/// A device id that was not given before.
pub(crate) fn next_device_id() -> DeviceId {
    static NEXT: AtomicU64 = AtomicU64::new(1);
    DeviceId(NEXT.fetch_add(1, Ordering::Relaxed))
}
