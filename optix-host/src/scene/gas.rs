//! What geometry acceleration structures are built of (guide 5).

use super::{Accel, BuiltAccel, GasInput, Geometry, Material, SceneState, Slot};
use crate::Result;
use crate::error::{BuildError, SceneError};
use crate::geometry::{BuildInput, BuildInputs, GasPrimitive, GeometryFlags, PrimitiveArray, Records};
use optix_device_rs::pipeline::HasHitGroup;
use optix_device_rs::record::SbtRecord;
use std::marker::PhantomData;
use std::sync::Arc;

/// Geometry with its materials, to go into a GAS.
pub struct GasMember<P, G: GasPrimitive> {
    primitives: Arc<G::Array>,
    /// One for each material.
    records: Records,
    /// The scene of each material.
    scenes: Vec<u64>,
    slots: Vec<Slot>,
    pipeline: PhantomData<fn(P)>,
}

impl<P, G: GasPrimitive> GasMember<P, G> {
    /// `records` makes records of the flags that all of them have, since all materials of one type have one hit group.
    pub(super) fn new<Rec: SbtRecord>(
        geometry: &Geometry<G>,
        materials: &[Material<P, Rec>],
        records: impl FnOnce(GeometryFlags) -> Records,
    ) -> Self
    where
        P: HasHitGroup<Rec, G>,
    {
        let group = <P as HasHitGroup<Rec, G>>::INDEX;
        let has_anyhit = P::DESCRIPTION.hitgroups[group as usize].rays.iter().any(|ray| ray.anyhit.is_some());
        let flags = if has_anyhit { GeometryFlags::NONE } else { GeometryFlags::DISABLE_ANYHIT };
        Self {
            primitives: geometry.primitives.clone(),
            records: records(flags),
            scenes: materials.iter().map(|material| material.scene).collect(),
            slots: materials.iter().map(|material| (material.index, group)).collect(),
            pipeline: PhantomData,
        }
    }

    /// How many primitives the geometry of each record has.
    pub(crate) fn primitives_by_record(&self) -> impl Iterator<Item = u32> {
        self.slots.iter().map(|_| self.primitives.len() as u32)
    }
}

impl SceneState {
    /// The input of a GAS for a machine, after a check that its members fit this scene and each other.
    pub(crate) fn gas_input<P, G: GasPrimitive>(
        &self,
        members: &[GasMember<P, G>],
        compact: bool,
        random_vertex_access: bool,
    ) -> Result<GasInput> {
        if members.is_empty() {
            return Err(SceneError::EmptyGas.into());
        }
        let inputs = members.iter().enumerate().map(|(index, member)| {
            if member.scenes.iter().any(|&scene| scene != self.id) {
                return Err(SceneError::ForeignMaterial { geometry: index }.into());
            }
            let input = BuildInput::<G::Array>::new(member.primitives.clone(), member.records.clone());
            Ok(input.map_err(|error| BuildError::Input { input: index, error })?)
        });
        let inputs = BuildInputs::from(inputs.collect::<Result<Vec<_>>>()?);
        Ok(GasInput { inputs, compact, random_vertex_access })
    }

    /// Adds the GAS that a machine built of these members.
    pub(crate) fn add_gas<P, G: GasPrimitive>(
        &mut self,
        members: &[GasMember<P, G>],
        input: &GasInput,
        built: BuiltAccel,
    ) -> Result<Accel<P>> {
        let slots = members.iter().flat_map(|m| m.slots.iter().copied()).collect();
        let first_slot = self.slots_for(slots)?;
        self.features.add_gas(&input.inputs);
        Ok(self.add_accel(built, 0, first_slot, Vec::new()))
    }
}
