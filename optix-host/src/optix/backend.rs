//! OptiX as a backend: it turns the scene's description and the plan into driver objects.

use super::driver::{
    self, Accel, AccelOptions, BoundValue, Context, ContextOptions, DebugLevel, DeviceBuffer, Entry, Intersection,
    LaunchArgs, LinkOptions, Module, ModuleOptions, PayloadSemantics, PayloadType, Pipeline, PipelineOptions,
    PrimitiveKinds, ProgramGroup, Programs, SbtSection, SbtSections, ShaderBindingTable as DeviceTable, Texture,
    TraversableGraph, stack::CallDepths,
};
use super::{OptixOptions, feedback};
use crate::backend::{Backend, Linked, Running, next_device_id};
use crate::error::PipelineError;
use crate::plan::{Graph, Plan};
use crate::sbt::{HEADER_SIZE, HitProgram, Section, ShaderBindingTable};
use crate::scene::{BuiltAccel, GasInput, IasInput, SceneError};
use crate::texture::TextureInput;
use crate::{Error, Result};
use optix_device_rs::host::{self as device, DeviceId, Kept, Memory, MemoryError, TextureMemory};
use std::collections::HashMap;
use std::sync::Arc;

/// A GPU through OptiX.
pub(crate) struct OptixBackend {
    id: DeviceId,
    pub(crate) context: Context,
}

impl OptixBackend {
    pub fn new(options: &OptixOptions) -> Result<Self> {
        let options = ContextOptions { validation: options.validation, ..Default::default() };
        Ok(Self::of(Context::new(&options).map_err(Error::NoOptix)?))
    }

    pub fn of(context: Context) -> Self {
        Self { id: next_device_id(), context }
    }

    pub fn description(&self) -> String {
        let info = self.context.info();
        let driver = info.driver_version.as_deref().unwrap_or("of unknown version");
        let (release, abi) = (self.context.optix_release(), self.context.abi_version());
        format!("OptiX {release} (ABI {abi}) on {}, driver {driver}", info.name)
    }
}

impl Backend for OptixBackend {
    fn id(&self) -> DeviceId {
        self.id
    }

    fn take_messages(&self) -> Vec<String> {
        let messages = self.context.take_messages().into_iter();
        messages.filter(driver::LogMessage::is_warning_or_worse).map(|m| format!("[{}] {}", m.tag, m.text)).collect()
    }

    fn allocate(&self, bytes: usize, _: usize) -> Result<Arc<dyn Memory>> {
        Ok(Arc::new(OptixMemory { device: self.id, buffer: DeviceBuffer::zeroed(&self.context, bytes)? }))
    }

    fn create_texture(&self, input: &TextureInput<'_>) -> Result<Arc<dyn TextureMemory>> {
        Ok(Arc::new(OptixTexture { device: self.id, texture: Texture::new(&self.context, input)? }))
    }

    /// On the device, programs call a record by its index, so the number is the index.
    fn number_callables(&self, index: u32, _: u32) -> Result<u32> {
        Ok(index)
    }

    fn build_gas(&self, input: &GasInput) -> Result<BuiltAccel> {
        let GasInput { inputs, compact, random_vertex_access } = input;
        let (compact, random_vertex_access) = (*compact, *random_vertex_access);
        let options = AccelOptions { compact, random_vertex_access, ..Default::default() };
        Ok(built(Accel::gas(&self.context, inputs, &options)?))
    }

    fn build_ias(&self, input: &IasInput) -> Result<BuiltAccel> {
        let instances = input.instances.iter().enumerate().map(|(i, instance)| {
            let child = instance.child.owner.downcast_ref::<Accel>();
            let child = child.ok_or(SceneError::InstanceOfAnotherDevice { instance: i })?;
            Ok(instance.with_child(child.into()))
        });
        let instances: Vec<_> = instances.collect::<Result<_>>()?;
        let options = AccelOptions { random_instance_access: input.random_instance_access, ..Default::default() };
        Ok(built(Accel::instances(&self.context, &instances, &options)?))
    }

    fn link(&self, plan: Arc<Plan>, sbt: ShaderBindingTable, _: &[Kept]) -> Result<Box<dyn Linked>> {
        Ok(Box::new(OptixPipeline::new(&self.context, &plan, sbt)?))
    }
}

pub(crate) struct OptixMemory {
    pub device: DeviceId,
    pub buffer: DeviceBuffer,
}

/// A texture on the GPU.
struct OptixTexture {
    device: DeviceId,
    texture: Texture,
}

// SAFETY: the object is destroyed after the launches that were begun before.
unsafe impl TextureMemory for OptixTexture {
    fn device(&self) -> DeviceId {
        self.device
    }
    fn number(&self) -> u64 {
        self.texture.object()
    }
}

fn memory_error(error: driver::Error) -> MemoryError {
    MemoryError::Driver(Arc::new(error))
}

// SAFETY: the buffer has so many bytes on the GPU, and is freed after the launches that were begun before.
unsafe impl Memory for OptixMemory {
    fn device(&self) -> DeviceId {
        self.device
    }
    fn address(&self) -> u64 {
        self.buffer.address()
    }
    fn byte_len(&self) -> usize {
        self.buffer.len()
    }
    fn read(&self, offset: usize, bytes: &mut [u8]) -> Result<(), MemoryError> {
        self.buffer.download(offset, bytes).map_err(memory_error)
    }
    fn write(&self, offset: usize, bytes: &[u8]) -> Result<(), MemoryError> {
        self.buffer.upload(offset, bytes).map_err(memory_error)
    }
}

fn built(accel: Accel) -> BuiltAccel {
    BuiltAccel { handle: accel.handle(), bytes: accel.size(), owner: Arc::new(accel) }
}

/// A pipeline with its table on the device.
struct OptixPipeline {
    pipeline: Pipeline,
    table: DeviceTable,
    details: Vec<String>,
}

impl OptixPipeline {
    fn new(context: &Context, plan: &Plan, sbt: ShaderBindingTable) -> Result<Self> {
        let ptx = plan.ptx.as_deref().unwrap_or_default();
        let options = pipeline_options(plan);
        let payloads = payload_types(plan)?;
        let bound_values = plan.bound.iter().map(|bound| BoundValue {
            offset: bound.field.offset,
            bytes: bound.bytes.clone(),
            annotation: bound.field.name.into(),
        });
        // If the shaders were compiled with line information, it is kept for profilers.
        let has_lines = ptx.lines().any(|line| line.trim_start().starts_with(".loc"));
        let module_options = ModuleOptions {
            debug: if has_lines { DebugLevel::Minimal } else { DebugLevel::Default },
            bound_values: bound_values.collect(),
            payload_types: payloads.clone(),
            ..Default::default()
        };
        let module = Module::from_ptx(context, ptx, &module_options, &options)?;

        let mut groups = Groups { context, module: &module, payloads: &payloads, made: HashMap::new() };
        let raygen = packed(sbt.raygen, |&i| groups.raygen(plan, i))?;
        let miss = packed(sbt.miss, |&ray| groups.miss(plan, ray))?;
        let hit = packed(sbt.hit, |&slot| groups.hit(plan, slot))?;
        let callables = packed(sbt.callables, |callable| groups.callable(plan, callable.program))?;
        let exception = packed(sbt.exception, |()| groups.exception(plan))?;
        let groups: Vec<_> = groups.made.into_values().collect();
        let group_count = groups.len();

        let link = LinkOptions {
            depths: CallDepths {
                trace: plan.depths.trace,
                continuation_callables: plan.depths.continuation,
                direct_callables_from_traversal: plan.depths.direct_from_traversal,
                direct_callables_from_state: plan.depths.direct_from_state,
            },
            max_graph_depth: plan.graph_depth,
            stack: None,
        };
        let pipeline = Pipeline::new(context, &groups, &options, &link)?;
        let sections = SbtSections {
            raygen: section(&raygen),
            miss: section(&miss),
            hitgroup: section(&hit),
            callables: section(&callables),
            exception: section(&exception),
        };
        let keep: driver::KeepAlive = vec![Arc::new(groups)];
        let table = DeviceTable::new(context, &sections, keep)?;
        let stack = pipeline.stack();
        let mut details = vec![
            format!("program groups: {group_count}"),
            format!(
                "stack: {} bytes of continuations, {} direct, {} direct during traversal",
                stack.continuation, stack.direct_from_state, stack.direct_from_traversal
            ),
            format!(
                "records: {} hit, {} miss, {} callable, stride {} bytes",
                hit.programs().len(),
                miss.programs().len(),
                callables.programs().len(),
                hit.stride()
            ),
        ];
        details.extend(feedback::bound_values(module.log(), &plan.bound));
        details.extend(module.log().lines().map(|line| format!("compiler: {line}")));
        Ok(Self { pipeline, table, details })
    }
}

fn section<K>(section: &Section<K>) -> SbtSection<'_> {
    SbtSection { bytes: section.bytes(), stride: section.stride() }
}

/// The section, with the headers of its programs' groups written into it.
fn packed<K: Copy>(mut section: Section<K>, mut group: impl FnMut(&K) -> Result<ProgramGroup>) -> Result<Section<K>> {
    for i in 0..section.programs().len() {
        let mut header = [0; HEADER_SIZE];
        group(&section.programs()[i])?.pack_header(&mut header)?;
        section.header_mut(i).copy_from_slice(&header);
    }
    Ok(section)
}

/// Makes each program group once.
struct Groups<'a> {
    context: &'a Context,
    module: &'a Module,
    payloads: &'a [PayloadType],
    made: HashMap<GroupKey, ProgramGroup>,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum GroupKey {
    Raygen(usize),
    Miss(usize),
    Hit(HitProgram),
    Callable(usize),
    Exception,
}

impl Groups<'_> {
    fn get(&mut self, key: GroupKey, programs: &Programs<'_>, ray: Option<usize>) -> Result<ProgramGroup> {
        if let Some(group) = self.made.get(&key) {
            return Ok(group.clone());
        }
        let group = ProgramGroup::new(self.context, programs, ray.map(|ray| &self.payloads[ray]))?;
        self.made.insert(key, group.clone());
        Ok(group)
    }

    fn raygen(&mut self, plan: &Plan, index: usize) -> Result<ProgramGroup> {
        let entry = Entry { module: self.module, name: plan.description.raygen[index].entry.name };
        self.get(GroupKey::Raygen(index), &Programs::Raygen(entry), None)
    }

    fn miss(&mut self, plan: &Plan, ray: usize) -> Result<ProgramGroup> {
        let module = self.module;
        let entry = plan.description.rays[ray].miss.map(|miss| Entry { module, name: miss.entry.name });
        self.get(GroupKey::Miss(ray), &Programs::Miss(entry), entry.map(|_| ray))
    }

    fn hit(&mut self, plan: &Plan, slot: HitProgram) -> Result<ProgramGroup> {
        let module = self.module;
        let programs = plan.description.hitgroups[slot.group].rays[slot.ray];
        let entry = |entry: Option<device::Entry>| entry.map(|entry| Entry { module, name: entry.name });
        let group = Programs::HitGroup {
            closesthit: entry(programs.closesthit),
            anyhit: entry(programs.anyhit),
            intersection: entry(programs.intersection).map(Intersection::Program),
        };
        let has_programs = [programs.closesthit, programs.anyhit, programs.intersection].iter().any(Option::is_some);
        self.get(GroupKey::Hit(slot), &group, has_programs.then_some(slot.ray))
    }

    /// OptiX allows a direct and a continuation callable in one group, with one record. Here each callable has its own
    /// type of record, so each has its own group.
    fn callable(&mut self, plan: &Plan, program: usize) -> Result<ProgramGroup> {
        let callable = &plan.description.callables[program];
        let entry = Some(Entry { module: self.module, name: callable.entry.name });
        let (direct, continuation) = if callable.continuation { (None, entry) } else { (entry, None) };
        self.get(GroupKey::Callable(program), &Programs::Callables { direct, continuation }, None)
    }

    fn exception(&mut self, plan: &Plan) -> Result<ProgramGroup> {
        let name = plan.description.exceptions.program.map_or("", |program| program.entry.name);
        self.get(GroupKey::Exception, &Programs::Exception(Entry { module: self.module, name }), None)
    }
}

fn pipeline_options(plan: &Plan) -> PipelineOptions {
    let primitives =
        plan.primitives.iter().fold(PrimitiveKinds::default(), |all, &kind| all.with(PrimitiveKinds::from(kind)));
    PipelineOptions {
        motion_blur: plan.motion,
        graph: match plan.graph {
            Graph::SingleGas => TraversableGraph::SingleGas,
            Graph::SingleLevelInstancing => TraversableGraph::SingleLevelInstancing,
            Graph::Any => TraversableGraph::Any,
        },
        attribute_values: plan.attribute_words,
        launch_params: Some(plan.description.params.symbol.into()),
        primitives,
        exceptions: driver::Exceptions {
            stack_overflow: plan.exceptions.stack_overflow,
            trace_depth: plan.exceptions.trace_depth,
            user: plan.exceptions.user,
        },
        ..Default::default()
    }
}

fn payload_types(plan: &Plan) -> Result<Vec<PayloadType>> {
    let types = plan.description.rays.iter().map(|ray| {
        let semantics = ray.payload.semantics.iter().map(|&bits| PayloadSemantics::from_bits(bits));
        let semantics = semantics.collect::<Option<Vec<_>>>().ok_or_else(|| Error::Pipeline {
            pipeline: plan.description.name,
            error: PipelineError::PayloadSemantics { payload: ray.payload.name },
        })?;
        Ok(PayloadType { semantics })
    });
    types.collect()
}

impl Linked for OptixPipeline {
    fn launch(&self, raygen: usize, params: &[u8], _: &[Kept], dimensions: [u32; 3]) -> Result<Box<dyn Running>> {
        let args = LaunchArgs { sbt: &self.table, raygen: raygen as u32, params, dims: dimensions, keep: Vec::new() };
        // SAFETY: parameters and records were lowered from the pipeline's own types, whose layout is asserted on both
        // sides; their views come from owners on this device, which `crate::Launch` and `crate::Pipeline` hold until the
        // launch is done; `Pipeline::check` refuses structures that the options or the table do not cover, and
        // `BoundValue::check` parameters that differ from bound ones.
        let launch = unsafe { self.pipeline.launch(args) }?;
        Ok(Box::new(OptixLaunch(Some(launch))))
    }

    fn details(&self) -> Vec<String> {
        self.details.clone()
    }
}

struct OptixLaunch(Option<driver::Launch>);

impl Running for OptixLaunch {
    fn wait(&mut self) -> Result<()> {
        if let Some(launch) = self.0.take() {
            launch.wait()?;
        }
        Ok(())
    }
}
