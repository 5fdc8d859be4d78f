//! Materials: a record that a hit group of the pipeline reads.

use super::{RecordData, SceneState, numbered};
use crate::Result;
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

impl SceneState {
    /// Adds a material with this record.
    pub(crate) fn add_material<P, Rec>(&mut self, record: RecordData) -> Result<Material<P, Rec>> {
        let index = numbered(self.materials.len(), "materials")?;
        self.materials.push(MaterialState { record });
        Ok(Material { scene: self.id, index, types: PhantomData })
    }
}
