//! Acceleration structures that a machine built (guide 5).

use super::{BuiltAccel, SceneState};
use crate::Result;
use crate::error::SceneError;
use crate::features::Roots;
use optix_device_rs::host::{DeviceId, World};
use std::marker::PhantomData;
use std::sync::Arc;

/// An acceleration structure of a scene. A clone is the same structure.
pub struct Accel<P> {
    pub(crate) shared: Arc<AccelShared>,
    pipeline: PhantomData<fn(P)>,
}

impl<P> Clone for Accel<P> {
    fn clone(&self) -> Self {
        Self { shared: self.shared.clone(), pipeline: PhantomData }
    }
}

/// What a launch checks of the structures it is given.
pub(crate) struct AccelShared {
    pub built: BuiltAccel,
    pub device: DeviceId,
    pub scene: u64,
    /// Levels of instances; 0 for a GAS.
    pub depth: u32,
    /// The slot of its first record. It is 0 for an IAS, whose instances have the offsets.
    pub(super) first_slot: u32,
    /// The number of slots that the table has at the least.
    pub slots: u32,
    /// The features of the scene.
    roots: Roots,
    /// Keeps the children alive.
    _children: Vec<Arc<AccelShared>>,
}

impl AccelShared {
    pub(crate) fn world(self: &Arc<Self>) -> World {
        // SAFETY: the backend's owner keeps the handle, and this is what the scene built with it.
        unsafe { World::new(self.built.handle, self.device, self.built.owner.clone(), self.clone()) }
    }
}

impl<P> Accel<P> {
    /// The structure for launch parameters and records: rays are traced against it.
    ///
    /// Only instances carry record offsets. So a GAS whose records are not the first of the table can't be traced
    /// against itself, but only through an IAS.
    pub fn world(&self) -> Result<World> {
        let shared = &self.shared;
        if shared.first_slot != 0 {
            return Err(SceneError::NotFirstGas.into());
        }
        shared.roots.add(shared.depth);
        Ok(shared.world())
    }

    /// Bytes of the finished structure, without its children.
    pub fn bytes(&self) -> usize {
        self.shared.built.bytes
    }
}

impl SceneState {
    /// A structure with `depth` levels of instances, which a machine built for this scene of these children.
    pub(super) fn add_accel<P>(
        &mut self,
        built: BuiltAccel,
        depth: u32,
        first_slot: u32,
        children: Vec<Arc<AccelShared>>,
    ) -> Accel<P> {
        self.features.add_structure(depth);
        let shared = AccelShared {
            built,
            device: self.device,
            scene: self.id,
            depth,
            first_slot,
            slots: self.slots.len() as u32,
            roots: self.features.roots.clone(),
            _children: children,
        };
        Accel { shared: Arc::new(shared), pipeline: PhantomData }
    }
}
