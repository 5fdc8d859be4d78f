//! What instance acceleration structures are built of (guide 5.4).

use super::{Accel, BuiltAccel, IasInput, InstanceFlags, InstanceInput, SceneState};
use crate::Result;
use crate::affine::Affine;
use crate::error::SceneError;
use crate::limits::{MAX_GRAPH_DEPTH, MAX_INSTANCE_NUMBER};
use glam::Affine3A;
use optix_device_rs::pipeline::Pipeline;

/// A structure placed in an IAS.
pub struct Instance<P> {
    child: Accel<P>,
    transform: Affine3A,
    id: u32,
    mask: u8,
    flags: InstanceFlags,
}

impl<P> Instance<P> {
    /// The application's id, below 2^28, which programs read by `instance_id`.
    pub fn id(mut self, id: u32) -> Self {
        self.id = id;
        self
    }

    /// Rays whose mask shares no bit with this one don't see the instance.
    pub fn mask(mut self, mask: u8) -> Self {
        self.mask = mask;
        self
    }

    /// With these flags.
    pub fn flags(mut self, flags: InstanceFlags) -> Self {
        self.flags = flags;
        self
    }
}

impl<P> Accel<P> {
    /// An instance of this structure: `transform` takes its object space to the space of the IAS.
    pub fn at(&self, transform: Affine3A) -> Instance<P> {
        Instance { child: self.clone(), transform, id: 0, mask: 0xff, flags: InstanceFlags::NONE }
    }
}

impl SceneState {
    /// What a machine builds an IAS of, after a check that each instance is one of this scene.
    pub(crate) fn ias_input<P: Pipeline>(
        &self,
        instances: &[Instance<P>],
        random_instance_access: bool,
    ) -> Result<IasInput> {
        if instances.is_empty() {
            return Err(SceneError::EmptyIas.into());
        }
        let mut inputs = Vec::with_capacity(instances.len());
        for (i, instance) in instances.iter().enumerate() {
            let child = &instance.child.shared;
            if child.scene != self.id {
                return Err(SceneError::ForeignInstance { instance: i }.into());
            }
            if instance.id > MAX_INSTANCE_NUMBER {
                return Err(SceneError::InstanceId { instance: i, id: instance.id }.into());
            }
            if let Some(flags) = instance.flags.conflict() {
                return Err(SceneError::InstanceFlags { instance: i, flags }.into());
            }
            let rows = glam::Mat4::from(instance.transform).transpose().to_cols_array();
            let transform = core::array::from_fn(|k| rows[k]);
            if !instance.transform.is_finite() {
                return Err(SceneError::NonFiniteTransform { instance: i, transform: instance.transform }.into());
            }
            if Affine::from_f32(&transform).inverse().is_none() {
                return Err(SceneError::SingularTransform { instance: i, transform: instance.transform }.into());
            }
            let sbt_offset = u64::from(child.first_slot) * u64::from(P::RAY_TYPES);
            let Some(sbt_offset) = u32::try_from(sbt_offset).ok().filter(|&offset| offset <= MAX_INSTANCE_NUMBER)
            else {
                return Err(SceneError::RecordOffset { instance: i, offset: sbt_offset }.into());
            };
            inputs.push(InstanceInput {
                transform,
                id: instance.id,
                mask: instance.mask,
                flags: instance.flags,
                sbt_offset,
                child: child.built.clone(),
            });
        }
        let depth = depth_over(instances);
        if depth as usize >= MAX_GRAPH_DEPTH {
            return Err(SceneError::GraphTooDeep { levels: depth }.into());
        }
        Ok(IasInput { instances: inputs, random_instance_access })
    }

    /// Takes the IAS that a machine built of these instances.
    pub(crate) fn add_ias<P>(&mut self, instances: Vec<Instance<P>>, built: BuiltAccel) -> Accel<P> {
        let depth = depth_over(&instances);
        self.add_accel(built, depth, 0, instances.into_iter().map(|instance| instance.child.shared).collect())
    }
}

/// Levels of instances of an IAS of these.
fn depth_over<P>(instances: &[Instance<P>]) -> u32 {
    instances.iter().map(|instance| instance.child.shared.depth + 1).max().unwrap_or(0)
}
