//! The parts of a scene: geometry, materials, and the acceleration structures that bring them together. They are
//! described and checked here, without a machine; [`Scene`](crate::Scene) builds them on one.

mod accel;
mod callable;
mod flags;
mod gas;
mod geometry;
mod ias;
mod input;
mod instance;
mod material;

pub use crate::error::{GeometryError, SceneError};
pub use accel::Accel;
pub(crate) use accel::AccelShared;
pub(crate) use callable::{CallableShared, CallableState};
pub use flags::InstanceFlags;
pub use gas::GasMember;
pub use geometry::Geometry;
pub use ias::Instance;
pub(crate) use input::{BuiltAccel, GasInput, IasInput};
pub use instance::{InstanceInput, InstanceLimits};
pub use material::Material;
pub(crate) use material::MaterialState;

use crate::Result;
use crate::features::Features;
use optix_device_rs::data::DeviceData;
use optix_device_rs::host::{DeviceId, HostData, KeepAlive, Kept, PipelineDescription};
use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, Ordering};

/// The content of a scene.
pub(crate) struct SceneState {
    /// Unique in the process.
    pub id: u64,
    pub device: DeviceId,
    pub materials: Vec<MaterialState>,
    /// Hit records in the order of the table, one per material use; each stands for one record per ray type.
    pub slots: Vec<Slot>,
    /// Where the records of a GAS with these materials begin.
    slots_of: HashMap<Vec<Slot>, u32>,
    /// The record of the miss program, for each ray type.
    pub miss: Vec<RecordData>,
    /// The record of each ray-generation program.
    pub raygen: Vec<RecordData>,
    /// Records of callables, in the order of the table.
    pub callables: Vec<CallableState>,
    /// The record of the exception program.
    pub exception: RecordData,
    pub features: Features,
}

/// A material on one kind of geometry: the indices of the material and of its hit group.
pub(crate) type Slot = (u32, u32);

/// A record's bytes, if it was given, and what keeps its views alive.
#[derive(Clone, Default)]
pub(crate) struct RecordData {
    pub bytes: Option<Vec<u8>>,
    pub keep: Vec<Kept>,
}

/// The scene whose table the programs need that are reached through this. `None` if they need no table.
fn scene_of(kept: &Kept) -> Option<u64> {
    match kept {
        Kept::Traced(world) => Some(world.scene::<AccelShared>()?.scene),
        Kept::Callables(_, shared) => Some(shared.downcast_ref::<CallableShared>()?.scene),
        Kept::Memory(_) | Kept::Texture(_) | Kept::Read(_) => None,
    }
}

impl SceneState {
    /// A scene without content, for a pipeline with this description, on this device.
    pub(crate) fn new(description: &PipelineDescription, device: DeviceId) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(1);
        // A record without data need not be given.
        let record = |size: usize| RecordData { bytes: (size == 0).then(Vec::new), keep: Vec::new() };
        Self {
            id: NEXT.fetch_add(1, Ordering::Relaxed),
            device,
            materials: Vec::new(),
            slots: Vec::new(),
            slots_of: HashMap::new(),
            miss: description.rays.iter().map(|ray| record(ray.miss.map_or(0, |m| m.record.size))).collect(),
            raygen: description.raygen.iter().map(|rg| record(rg.record.size)).collect(),
            callables: Vec::new(),
            exception: record(description.exceptions.program.map_or(0, |program| program.record.size)),
            features: Features::default(),
        }
    }

    /// The bytes of a record on the device, after a check that what it points to belongs to this scene and device.
    pub(crate) fn lower<T: HostData>(&self, record: &T) -> Result<RecordData> {
        // SAFETY: the record keeps the owners beside the bytes.
        let mut keep = unsafe { KeepAlive::new() };
        let device_data = record.lower(&mut keep);
        if let Some(kept) = keep.foreign(self.device) {
            return Err(SceneError::RecordOfAnotherDevice { holds: kept.kind() }.into());
        }
        if let Some(kept) = keep.kept().iter().find(|kept| scene_of(kept).is_some_and(|scene| scene != self.id)) {
            return Err(SceneError::RecordOfAnotherScene { holds: kept.kind() }.into());
        }
        let mut bytes = vec![0; size_of::<T::Device>()];
        device_data.write_to(&mut bytes);
        Ok(RecordData { bytes: Some(bytes), keep: keep.into_kept() })
    }

    /// What the records point to.
    pub(crate) fn kept(&self) -> impl Iterator<Item = &Kept> {
        let records = self.materials.iter().map(|m| &m.record).chain(&self.miss).chain(&self.raygen);
        let records = records.chain(self.callables.iter().map(|c| &c.record)).chain([&self.exception]);
        records.flat_map(|record| &record.keep)
    }

    /// The slot at which the records of a GAS with these materials begin. GASes with the same list share their records.
    pub(crate) fn slots_for(&mut self, materials: Vec<Slot>) -> Result<u32> {
        if let Some(&first) = self.slots_of.get(&materials) {
            return Ok(first);
        }
        let first = numbered(self.slots.len(), "records of geometry")?;
        numbered(self.slots.len() + materials.len(), "records of geometry")?;
        self.features.hit_groups.extend(materials.iter().map(|&(_, group)| group as usize));
        self.slots.extend_from_slice(&materials);
        self.slots_of.insert(materials, first);
        Ok(first)
    }
}

/// Checks that 32 bits can hold the count.
pub(crate) fn numbered(count: usize, what: &'static str) -> Result<u32> {
    u32::try_from(count).map_err(|_| SceneError::TooMany { what, count }.into())
}
