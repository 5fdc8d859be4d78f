//! Materials: a record that a hit group of the pipeline reads.

use super::{RecordData, Scene, numbered};
use crate::Result;
use optix_device_rs::attributes::Geometry as GeometryKindOf;
use optix_device_rs::pipeline::{HasHitGroup, Pipeline};
use optix_device_rs::record::SbtRecord;
use std::marker::PhantomData;

/// A material of a scene: the data of its record, to be put on geometry whose kind the pipeline has a hit group for.
pub struct Material<P, Rec> {
    pub(crate) scene: u64,
    pub(crate) index: u32,
    types: PhantomData<fn(P, Rec)>,
}

impl<P, Rec> Clone for Material<P, Rec> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<P, Rec> Copy for Material<P, Rec> {}

/// A material as the scene keeps it.
pub(crate) struct MaterialState {
    pub record: RecordData,
}

impl<P: Pipeline> Scene<P> {
    /// Adds a material; `record` is the record struct, or its host twin where it holds views.
    pub fn material<H>(&mut self, record: H) -> Result<Material<P, H::Device>>
    where
        H: optix_device_rs::host::Twin<Device: SbtRecord<Host = H>>,
    {
        let record = self.lower(&record)?;
        let index = numbered(self.state.materials.len(), "materials")?;
        self.state.materials.push(MaterialState { record });
        Ok(Material { scene: self.state.id, index, types: PhantomData })
    }
}

impl<P, Rec: SbtRecord> Material<P, Rec> {
    /// The hit group it has on geometry `G`.
    pub(crate) const fn hitgroup<G: GeometryKindOf>(&self) -> u32
    where
        P: HasHitGroup<Rec, G>,
    {
        <P as HasHitGroup<Rec, G>>::INDEX
    }
}
