//! What instance acceleration structures are built of (guide 5.4).

use super::{Accel, BuiltAccel, IasInput, InstanceFlags, InstanceInput, SceneState};
use crate::Result;
use crate::error::SceneError;
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
    /// The input of an IAS for a machine, after a check that each instance belongs to this scene.
    pub(crate) fn ias_input<P: Pipeline>(
        &self,
        instances: &[Instance<P>],
        random_instance_access: bool,
    ) -> Result<IasInput> {
        if instances.is_empty() {
            return Err(SceneError::EmptyIas.into());
        }
        let input = |(index, instance): (usize, &Instance<P>)| {
            let child = &instance.child.shared;
            if child.scene != self.id {
                return Err(SceneError::ForeignInstance { instance: index });
            }
            let first_record = u64::from(child.first_slot) * u64::from(P::RAY_TYPES);
            let rows = glam::Mat4::from(instance.transform).transpose().to_cols_array();
            Ok(InstanceInput {
                transform: core::array::from_fn(|element| rows[element]),
                id: instance.id,
                // An offset that does not fit 32 bits does not fit 28 either, which the machine refuses.
                sbt_offset: u32::try_from(first_record).unwrap_or(u32::MAX),
                visibility_mask: instance.mask,
                flags: instance.flags,
                child: child.built.clone(),
            })
        };
        let inputs = instances.iter().enumerate().map(input).collect::<Result<_, _>>()?;
        Ok(IasInput { instances: inputs, random_instance_access })
    }

    /// Adds the IAS that a machine built of these instances.
    pub(crate) fn add_ias<P>(&mut self, instances: Vec<Instance<P>>, built: BuiltAccel) -> Accel<P> {
        let depth = instances.iter().map(|instance| instance.child.shared.depth + 1).max().unwrap_or(0);
        self.add_accel(built, depth, 0, instances.into_iter().map(|instance| instance.child.shared).collect())
    }
}
