//! What geometry acceleration structures are built of (guide 5).

use super::{Accel, BuildInput, BuiltAccel, GasInput, Geometry, GeometryData, SceneState};
use crate::Result;
use crate::error::SceneError;
use optix_device_rs::attributes::Geometry as GeometryKindOf;
use optix_device_rs::pipeline::Pipeline;
use std::marker::PhantomData;
use std::sync::Arc;

/// Geometry with its material, to go into a GAS.
pub struct GasMember<P, G> {
    data: Arc<GeometryData>,
    /// Whose material it is, per record.
    scenes: Vec<u64>,
    /// Material and hit group per record.
    records: Vec<(u32, u32)>,
    record_of_primitive: Option<Vec<u32>>,
    types: PhantomData<fn(P, G)>,
}

impl<P, G> GasMember<P, G> {
    pub(super) fn new(
        geometry: &Geometry<G>,
        scenes: Vec<u64>,
        records: Vec<(u32, u32)>,
        record_of_primitive: Option<Vec<u32>>,
    ) -> Self {
        Self { data: geometry.data.clone(), scenes, records, record_of_primitive, types: PhantomData }
    }

    /// How many primitives the geometry of each record has.
    pub(crate) fn primitives_by_record(&self) -> impl Iterator<Item = u32> {
        self.records.iter().map(|_| self.data.primitives() as u32)
    }
}

impl SceneState {
    /// What a machine builds a GAS of, after a check that its members fit this scene and each other.
    pub(crate) fn gas_input<P: Pipeline, G: GeometryKindOf>(
        &self,
        members: &[GasMember<P, G>],
        compact: bool,
        random_vertex_access: bool,
    ) -> Result<GasInput> {
        if members.is_empty() {
            return Err(SceneError::EmptyGas.into());
        }
        for (i, member) in members.iter().enumerate() {
            if member.scenes.iter().any(|&scene| scene != self.id) {
                return Err(SceneError::ForeignMaterial { geometry: i }.into());
            }
            check_records(i, member)?;
        }
        let description = P::DESCRIPTION;
        let inputs = members.iter().map(|member| BuildInput {
            geometry: member.data.clone(),
            record_has_anyhit: member
                .records
                .iter()
                .map(|&(_, group)| description.hitgroups[group as usize].rays.iter().any(|r| r.anyhit.is_some()))
                .collect(),
            record_of_primitive: member.record_of_primitive.clone(),
        });
        Ok(GasInput { kind: G::KIND, inputs: inputs.collect(), compact, random_vertex_access })
    }

    /// Takes the GAS that a machine built of these members.
    pub(crate) fn add_gas<P, G: GeometryKindOf>(
        &mut self,
        members: &[GasMember<P, G>],
        built: BuiltAccel,
    ) -> Result<Accel<P>> {
        let records = members.iter().flat_map(|m| m.records.iter().copied()).collect();
        let first_slot = self.slots_for(records)?;
        self.usage.add(G::KIND);
        Ok(self.add_accel(built, 0, first_slot, Vec::new()))
    }
}

fn check_records<P, G>(geometry: usize, member: &GasMember<P, G>) -> Result<(), SceneError> {
    let Some(which) = &member.record_of_primitive else { return Ok(()) };
    let (primitives, materials) = (member.data.primitives(), member.records.len());
    if which.len() != primitives {
        return Err(SceneError::MaterialNumbers { geometry, primitives, numbers: which.len() });
    }
    match which.iter().position(|&w| w as usize >= materials) {
        Some(primitive) => Err(SceneError::NoSuchMaterial { geometry, primitive, number: which[primitive], materials }),
        None => Ok(()),
    }
}
