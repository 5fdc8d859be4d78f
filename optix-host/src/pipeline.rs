//! Pipelines: specialised to a scene, and linked for its device.

pub use crate::plan::{Explanation, Note};

use crate::backend::Linked;
use crate::build::Scene;
use crate::error::{PipelineError, ReferenceError};
use crate::plan::{BoundValue, Plan};
use crate::sbt::ShaderBindingTable;
use crate::scene::{AccelShared, CallableShared};
use crate::{BackendKind, Device, Error, Result};
use optix_device_rs::data::DeviceData;
use optix_device_rs::host::Kept;
use optix_device_rs::params::Bound;
use optix_device_rs::pipeline::Pipeline as PipelineType;
use std::marker::PhantomData;
use std::sync::Arc;

/// A pipeline of type `P`, specialised to a scene and ready to launch on its device.
pub struct Pipeline<P> {
    pub(crate) linked: Box<dyn Linked>,
    pub(crate) plan: Arc<Plan>,
    pub(crate) device: Device,
    scene: u64,
    slots: u32,
    callables: u32,
    /// What the records' views point to.
    pub(crate) records: Vec<Kept>,
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

    /// Checks that this pipeline's programs may use what its parameters or a record hold: its table and its flags have
    /// to cover it.
    pub(crate) fn check(&self, kept: &Kept) -> Result<(), ReferenceError> {
        let made = match kept {
            Kept::Traced(world) => world.scene::<AccelShared>().map(|accel| (accel.scene, accel.slots > self.slots)),
            Kept::Callables(_, shared) => {
                shared.downcast_ref::<CallableShared>().map(|table| (table.scene, table.end > self.callables))
            }
            Kept::Memory(_) | Kept::Texture(_) | Kept::Read(_) => return Ok(()),
        };
        let held = kept.kind();
        match made {
            None => return Err(ReferenceError::NoScene { held }),
            Some((scene, _)) if scene != self.scene => return Err(ReferenceError::AnotherScene { held }),
            Some((_, true)) => return Err(ReferenceError::MadeLater { held }),
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
        let error = |error| Error::Pipeline { pipeline: P::DESCRIPTION.name, error };
        if device.kind() == BackendKind::Optix && ptx.is_none() {
            return Err(error(PipelineError::NoPtx));
        }
        let plan = Arc::new(Plan::new(P::DESCRIPTION, &state.features, ptx, self.bound)?);
        let sbt = ShaderBindingTable::of(state, &plan)?;
        let records: Vec<_> = state.kept().cloned().collect();
        let linked = device.backend.link(plan.clone(), sbt, &records)?;
        let (slots, callables) = (state.slots.len() as u32, state.callables.len() as u32);
        let pipeline =
            Pipeline { linked, plan, device, scene: state.id, slots, callables, records, pipeline: PhantomData };
        let checked = pipeline.records.iter().try_for_each(|kept| pipeline.check(kept));
        checked.map_err(|reference| error(PipelineError::Record(reference)))?;
        Ok(pipeline)
    }
}
