//! Pipelines: specialised to a scene, built for a device, launched.

pub use crate::plan::{Explanation, Note};

use crate::backend::{Linked, Running};
use crate::plan::{BoundValue, Plan};
use crate::sbt::ShaderBindingTable;
use crate::scene::{AccelShared, CallableShared, Scene};
use crate::{BackendKind, Device, Error, Result};
use optix_device_rs::data::DeviceData;
use optix_device_rs::host::{KeepAlive, Kept, Twin};
use optix_device_rs::params::{Bound, LaunchParams};
use optix_device_rs::pipeline::{HasRayGen, Pipeline as PipelineType};
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
    records: Vec<Kept>,
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
        let size = dimensions.iter().map(|&d| u128::from(d)).product::<u128>();
        let [w, h, d] = dimensions;
        if size == 0 {
            return Err(error(format!("its dimensions {w} x {h} x {d} are empty")));
        }
        if size > 1 << 30 {
            return Err(error(format!("its dimensions {w} x {h} x {d} are more than 2^30 (guide 12)")));
        }
        // SAFETY: the launch that is given the views keeps the owners.
        let mut keep = unsafe { KeepAlive::new() };
        let device_params = params.lower(&mut keep);
        if let Some(kept) = keep.foreign(self.device.backend.id()) {
            return Err(error(format!("its parameters hold {} of another device", kept.kind())));
        }
        keep.kept().iter().try_for_each(|kept| self.check("its parameters hold", kept)).map_err(error)?;
        let mut bytes = vec![0; size_of::<P::Params>()];
        device_params.write_to(&mut bytes);
        for bound in &self.plan.bound {
            bound.check(&bytes).map_err(error)?;
        }
        let running = self.linked.launch(raygen, &bytes, keep.kept(), dimensions)?;
        let mut kept = keep.into_kept();
        kept.extend(self.records.iter().cloned());
        Ok(Launch { running, done: false, _keep: kept })
    }

    /// Whether this pipeline's programs may use what its parameters or a record hold: its table and its flags cover that.
    fn check(&self, holder: &str, kept: &Kept) -> Result<(), String> {
        let (made, more) = match kept {
            Kept::Traced(world) => {
                (world.scene::<AccelShared>().map(|accel| (accel.scene, accel.slots > self.slots)), "materials")
            }
            Kept::Callables(_, shared) => {
                let table = shared.downcast_ref::<CallableShared>();
                (table.map(|table| (table.scene, table.end > self.callables)), "callables")
            }
            Kept::Memory(_) | Kept::Read(_) => return Ok(()),
        };
        match made {
            None => return Err(format!("{holder} {} that no scene made", kept.kind())),
            Some((scene, _)) if scene != self.scene => {
                return Err(format!("{holder} {} of another scene than the pipeline's", kept.kind()));
            }
            Some((_, true)) => {
                return Err(format!(
                    "the scene got more {more} after the pipeline was built: build the pipeline again"
                ));
            }
            Some((_, false)) => {}
        }
        let Kept::Traced(world) = kept else { return Ok(()) };
        let depth = world.scene::<AccelShared>().map_or(0, |accel| accel.depth);
        self.plan.allows(depth)
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
        let records: Vec<_> = state.kept().cloned().collect();
        let linked = device.backend.link(plan.clone(), sbt, &records)?;
        let (slots, callables) = (state.slots.len() as u32, state.callables.len() as u32);
        let pipeline =
            Pipeline { linked, plan, device, scene: state.id, slots, callables, records, pipeline: PhantomData };
        let checked = pipeline.records.iter().try_for_each(|kept| pipeline.check("a record holds", kept));
        checked.map_err(|what| Error::Pipeline { pipeline: P::DESCRIPTION.name, what })?;
        Ok(pipeline)
    }
}

/// A launch under way; it keeps alive what it uses. Dropping it waits for its end.
#[must_use = "a launch that is dropped is waited for, and its errors are lost"]
pub struct Launch {
    running: Box<dyn Running>,
    done: bool,
    _keep: Vec<Kept>,
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
