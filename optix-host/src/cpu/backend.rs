//! The CPU as a backend: it turns the scene's description into structures for traversal and runs launches.

use super::executor::{self, Callables, Launch, Reached};
use super::memory::CpuMemory;
use super::texture::CpuTexture;
use super::traversal::{Accel, Gas, Ias};
use crate::Result;
use crate::backend::{Backend, Linked, Running, next_device_id};
use crate::plan::Plan;
use crate::sbt::ShaderBindingTable;
use crate::scene::{BuiltAccel, GasInput, IasInput, SceneError};
use crate::texture::TextureInput;
use optix_device_rs::host::{DeviceId, Handle, Kept, Memory, Sampler, TextureMemory};
use std::any::Any;
use std::ptr::NonNull;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};
use std::sync::{Arc, Mutex, PoisonError};

/// The CPU.
pub(crate) struct CpuBackend {
    id: DeviceId,
    checked: bool,
    messages: Messages,
}

/// Exceptions that no program was told of.
type Messages = Arc<Mutex<Vec<String>>>;

impl CpuBackend {
    pub fn new() -> Self {
        Self { id: next_device_id(), checked: false, messages: Messages::default() }
    }

    /// One that ends a launch, with the rule in the error, where a program does what the guide calls undefined.
    pub fn checked() -> Self {
        Self { checked: true, ..Self::new() }
    }

    pub fn description(&self) -> String {
        let checked = if self.checked { ", checked" } else { "" };
        format!("CPU executor, {} threads{checked}", rayon::current_num_threads())
    }
}

impl Backend for CpuBackend {
    fn id(&self) -> DeviceId {
        self.id
    }

    fn take_messages(&self) -> Vec<String> {
        core::mem::take(&mut self.messages.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn allocate(&self, bytes: usize, width: usize) -> Result<Arc<dyn Memory>> {
        Ok(Arc::new(CpuMemory::zeroed(self.id, bytes, width)?))
    }

    fn create_texture(&self, input: &TextureInput<'_>) -> Result<Arc<dyn TextureMemory>> {
        Ok(Arc::new(CpuTexture::new(self.id, input)))
    }

    fn build_gas(&self, input: &GasInput) -> Result<BuiltAccel> {
        Ok(built(Gas::new(input.inputs.clone())?.into()))
    }

    fn build_ias(&self, input: &IasInput) -> Result<BuiltAccel> {
        let instances = input.instances.iter().enumerate().map(|(i, instance)| {
            let child = instance.child.owner.downcast_ref::<CpuAccel>();
            let child = child.ok_or(SceneError::InstanceOfAnotherDevice { instance: i })?;
            Ok(instance.with_child(child.accel.clone()))
        });
        Ok(built(Ias::new(instances.collect::<Result<_>>()?)?.into()))
    }

    /// Numbers never come twice, so that a reference which a program kept from another scene's launch names nothing.
    fn number_callables(&self, _: u32, count: u32) -> Result<u32> {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let next = NEXT.fetch_update(Relaxed, Relaxed, |next| next.checked_add(count));
        next.map_err(|_| SceneError::TooManyCallables.into())
    }

    fn link(&self, plan: Arc<Plan>, sbt: ShaderBindingTable, kept: &[Kept]) -> Result<Box<dyn Linked>> {
        let (checked, messages) = (self.checked, self.messages.clone());
        let callables = Callables::of(&sbt.callables);
        Ok(Box::new(CpuPipeline { plan, sbt, callables, kept: kept.to_vec(), checked, messages }))
    }
}

/// A structure, and the number that programs know it by.
struct CpuAccel {
    handle: Handle,
    accel: Arc<Accel>,
}

fn built(accel: Accel) -> BuiltAccel {
    let bytes = accel.memory_bytes();
    let owner = Arc::new(CpuAccel { handle: Handle::issue(), accel: Arc::new(accel) });
    BuiltAccel { handle: owner.handle.number(), owner, bytes }
}

/// What programs of a launch may use.
fn reached<'a>(kept: impl IntoIterator<Item = &'a Kept>) -> Reached<'a> {
    let mut reached = Reached::default();
    for kept in kept {
        match kept {
            Kept::Memory(memory) => {
                let memory: &dyn Any = &**memory;
                if let Some(memory) = memory.downcast_ref::<CpuMemory>() {
                    // SAFETY: the memory has what its buffers have (`Buffer::from_memory`), is accessed by atomics of one width, and lives
                    // as long as `kept` is borrowed, which is until the launch is over.
                    unsafe { reached.memory.insert(memory.handle(), memory.bytes()) };
                }
            }
            Kept::Texture(texture) => {
                let texture: &dyn Any = &**texture;
                if let Some(texture) = texture.downcast_ref::<CpuTexture>() {
                    // SAFETY: it lives as long as `kept` is borrowed, which is until the launch is over.
                    unsafe { reached.memory.insert_texture(texture.handle(), NonNull::from(texture as &dyn Sampler)) };
                }
            }
            Kept::Traced(world) => {
                if let Some(built) = world.machine().downcast_ref::<CpuAccel>() {
                    reached.traced.insert(&built.handle, &*built.accel);
                }
            }
            Kept::Read(world) => {
                if let Some(built) = world.machine().downcast_ref::<CpuAccel>() {
                    reached.read.insert(&built.handle, &*built.accel);
                }
            }
            Kept::Callables(..) => {}
        }
    }
    reached
}

struct CpuPipeline {
    plan: Arc<Plan>,
    sbt: ShaderBindingTable,
    callables: Callables,
    /// What the records point to.
    kept: Vec<Kept>,
    checked: bool,
    messages: Messages,
}

impl Linked for CpuPipeline {
    fn launch(&self, raygen: usize, params: &[u8], kept: &[Kept], dimensions: [u32; 3]) -> Result<Box<dyn Running>> {
        let mut reached = reached(self.kept.iter().chain(kept));
        reached.memory.name(self.plan.description.params.fields, params);
        reached.callables = self.callables.clone();
        let launch = Launch::new(&self.plan, &self.sbt, params, reached, raygen, dimensions, self.checked);
        let messages = executor::run(launch)?;
        self.messages.lock().unwrap_or_else(PoisonError::into_inner).extend(messages);
        Ok(Box::new(Done))
    }

    fn details(&self) -> Vec<String> {
        let records = format!(
            "records: {} hit, {} miss, {} callable, stride {} bytes",
            self.sbt.hit.programs().len(),
            self.sbt.miss.programs().len(),
            self.sbt.callables.programs().len(),
            self.sbt.hit.stride()
        );
        let bound = self.plan.bound.iter().map(|value| {
            let name = value.field.name;
            format!("bound value {name}: the CPU loads it from each launch's parameters, which have the bound value")
        });
        core::iter::once(records).chain(bound).collect()
    }
}

/// A CPU launch is over when `launch` returns.
struct Done;

impl Running for Done {
    fn wait(&mut self) -> Result<()> {
        Ok(())
    }
}
