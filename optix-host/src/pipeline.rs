//! Pipelines: specialised to a scene, built for a device, launched.

pub use crate::plan::{Explanation, Note};

use crate::backend::{Linked, Running};
use crate::plan::{BoundValue, Plan};
use crate::sbt::ShaderBindingTable;
use crate::scene::{AccelShared, CallableShared, RecordData, Scene};
use crate::{BackendKind, Device, Error, Result};
use optix_device_rs::data::DeviceData;
use optix_device_rs::host::{KeepAlive, Twin};
use optix_device_rs::params::{Bound, LaunchParams};
use optix_device_rs::pipeline::{HasRayGen, Pipeline as PipelineType};
use std::any::Any;
use std::marker::PhantomData;
use std::sync::Arc;

/// A pipeline of type `P`, specialised to a scene and ready to launch on its device.
pub struct Pipeline<P> {
    linked: Box<dyn Linked>,
    plan: Arc<Plan>,
    device: Device,
    scene: u64,
    slots: u32,
    callables: u32,
    /// What the records' views point to.
    records: Vec<Arc<dyn Any + Send + Sync>>,
    pipeline: PhantomData<fn(P)>,
}

/// Gathers what a pipeline is specialised to.
pub struct PipelineBuilder<'s, P> {
    scene: &'s Scene<P>,
    ptx: Option<&'s str>,
    bound: Vec<BoundValue>,
}

impl<P: PipelineType> Pipeline<P> {
    /// A pipeline for this scene: what the scene does not need is left out.
    pub fn for_scene(scene: &Scene<P>) -> PipelineBuilder<'_, P> {
        PipelineBuilder { scene, ptx: None, bound: Vec::new() }
    }

    /// Launches the first ray-generation program over `dimensions` (width, height, depth; at most 2^30 in all).
    ///
    /// The launch runs on; what it writes is read after it by order of the device's work, and what it uses is kept alive.
    pub fn launch(&self, params: &<P::Params as LaunchParams>::Host, dimensions: [u32; 3]) -> Result<Launch> {
        self.begin(0, params, dimensions)
    }

    /// Launches ray-generation program `Prog`; see [`Pipeline::launch`].
    pub fn launch_program<Prog>(
        &self,
        params: &<P::Params as LaunchParams>::Host,
        dimensions: [u32; 3],
    ) -> Result<Launch>
    where
        P: HasRayGen<Prog>,
    {
        self.begin(<P as HasRayGen<Prog>>::INDEX as usize, params, dimensions)
    }

    fn begin(&self, raygen: usize, params: &<P::Params as LaunchParams>::Host, dimensions: [u32; 3]) -> Result<Launch> {
        let error = |what: String| Error::Launch { pipeline: self.plan.description.name, what };
        let size = dimensions.iter().map(|&d| d as u64).product::<u64>();
        let [w, h, d] = dimensions;
        if size == 0 {
            return Err(error(format!("its dimensions {w} x {h} x {d} are empty")));
        }
        if size > 1 << 30 || dimensions.iter().any(|&d| d as u64 > 1 << 30) {
            return Err(error(format!("its dimensions {w} x {h} x {d} are more than 2^30 (guide 12)")));
        }
        // SAFETY: the launch that is given the views keeps the owners.
        let mut keep = unsafe { KeepAlive::new() };
        let device_params = params.lower(&mut keep);
        if let Some(what) = keep.foreign(self.device.backend.id()) {
            return Err(error(format!("its parameters hold a {what} of another device")));
        }
        for owner in keep.owners() {
            if let Some(accel) = owner.downcast_ref::<AccelShared>() {
                self.check_world(accel).map_err(error)?;
            }
            if let Some(callables) = owner.downcast_ref::<CallableShared>() {
                self.check_callables(callables).map_err(error)?;
            }
        }
        let mut bytes = vec![0; size_of::<P::Params>()];
        device_params.write_to(&mut bytes);
        for bound in &self.plan.bound {
            bound.check(&bytes).map_err(error)?;
        }
        let running = self.linked.launch(raygen, &bytes, dimensions)?;
        let mut owners = keep.into_owners();
        owners.extend(self.records.iter().cloned());
        Ok(Launch { running, done: false, _keep: owners })
    }

    /// Whether rays may be traced against this structure with this pipeline's table and flags.
    fn check_world(&self, accel: &AccelShared) -> Result<(), String> {
        if accel.scene != self.scene {
            return Err("it traces against an acceleration structure of another scene than the pipeline's".into());
        }
        if accel.slots > self.slots {
            return Err("the scene got more materials after the pipeline was built: build the pipeline again".into());
        }
        self.plan.allows(accel.depth)
    }

    /// Whether the pipeline's table has these callables.
    fn check_callables(&self, callables: &CallableShared) -> Result<(), String> {
        if callables.scene != self.scene {
            return Err("its parameters hold a callable of another scene than the pipeline's".into());
        }
        if callables.end > self.callables {
            return Err("the scene got more callables after the pipeline was built: build the pipeline again".into());
        }
        Ok(())
    }

    /// What was specialised, what was left out, and why.
    pub fn explain(&self) -> Explanation {
        let mut explanation = self.plan.explanation();
        explanation.device = self.linked.details();
        explanation
    }
}

impl<'s, P: PipelineType> PipelineBuilder<'s, P> {
    /// The PTX of the shader crate that declares `P`: `optix_host::ptx!(crate_name)`. The CPU does not need it.
    pub fn ptx(mut self, ptx: &'s str) -> Self {
        self.ptx = Some(ptx);
        self
    }

    /// Makes a `#[bound]` parameter a constant of the pipeline (guide 6.5.1). Launches must pass the same value.
    pub fn bind<T: DeviceData>(mut self, field: Bound<P::Params, T>, value: T) -> Self {
        let mut bytes = vec![0; size_of::<T>()];
        value.write_to(&mut bytes);
        let field = field.field();
        self.bound.retain(|b| b.field != field);
        self.bound.push(BoundValue { field, bytes });
        self
    }

    /// Builds it.
    pub fn build(self) -> Result<Pipeline<P>> {
        let state = &self.scene.state;
        let device = self.scene.device.clone();
        let ptx = self.ptx.filter(|ptx| !ptx.is_empty());
        if device.kind() == BackendKind::Optix && ptx.is_none() {
            return Err(Error::Pipeline {
                pipeline: P::DESCRIPTION.name,
                what: "OptiX needs the shaders' PTX: give it with `.ptx(optix_host::ptx!(..))`, and where it is empty run \
                       `cargo optix setup` and build again"
                    .into(),
            });
        }
        let plan = Arc::new(Plan::new(P::DESCRIPTION, state, ptx, self.bound)?);
        let sbt = ShaderBindingTable::of(state, &plan)?;
        let linked = device.backend.link(plan.clone(), sbt)?;
        let records = state.materials.iter().map(|m| &m.record).chain(&state.miss).chain(&state.raygen);
        let records = records.chain(state.callables.iter().map(|c| &c.record)).chain([&state.exception]);
        Ok(Pipeline {
            linked,
            plan,
            device,
            scene: state.id,
            slots: state.slots.len() as u32,
            callables: state.callables.len() as u32,
            records: records.flat_map(|RecordData { keep, .. }| keep.iter().cloned()).collect(),
            pipeline: PhantomData,
        })
    }
}

/// A launch under way; it keeps alive what it uses. Dropping it waits for its end.
#[must_use = "a launch that is dropped is waited for, and its errors are lost"]
pub struct Launch {
    running: Box<dyn Running>,
    done: bool,
    _keep: Vec<Arc<dyn Any + Send + Sync>>,
}

impl Launch {
    /// Waits until the launch is done, and says what went wrong in it.
    pub fn wait(mut self) -> Result<()> {
        self.done = true;
        self.running.wait()
    }
}

impl Drop for Launch {
    fn drop(&mut self) {
        if !self.done {
            // An error has nobody to go to here; `wait` is the way to hear of it.
            let _ = self.running.wait();
        }
    }
}
