//! Geometry of a scene, to be put into acceleration structures with materials.

use super::{GasMember, Material};
use crate::error::GeometryError;
use crate::geometry::{GasPrimitive, IntoGeometry, PrimitiveArray, Records};
use crate::limits::MAX_PRIMITIVES;
use optix_device_rs::pipeline::HasHitGroup;
use optix_device_rs::record::SbtRecord;
use std::sync::Arc;

/// Geometry of kind `G`, to be put into acceleration structures with a material. A clone is the same geometry.
pub struct Geometry<G: GasPrimitive> {
    pub(super) primitives: Arc<G::Array>,
}

impl<G: GasPrimitive> Clone for Geometry<G> {
    fn clone(&self) -> Self {
        Self { primitives: self.primitives.clone() }
    }
}

impl<G: GasPrimitive> Geometry<G> {
    /// Checks and copies what was given.
    pub(crate) fn of(geometry: impl IntoGeometry<Kind = G>) -> Result<Self, GeometryError> {
        let primitives = geometry.check()?;
        match primitives.len() {
            0 => Err(GeometryError::Empty { what: G::Array::NAME }),
            count if count > MAX_PRIMITIVES => Err(GeometryError::TooMany { count }),
            _ => Ok(Self { primitives: Arc::new(primitives) }),
        }
    }

    /// This geometry with one material for all its primitives.
    pub fn with<P, Rec: SbtRecord>(&self, material: &Material<P, Rec>) -> GasMember<P, G>
    where
        P: HasHitGroup<Rec, G>,
    {
        GasMember::new(self, &[*material], Records::one)
    }

    /// This geometry with a material per primitive: primitive `i` has `materials[which[i]]`.
    pub fn with_each<P, Rec: SbtRecord>(&self, materials: &[Material<P, Rec>], which: Vec<u32>) -> GasMember<P, G>
    where
        P: HasHitGroup<Rec, G>,
    {
        GasMember::new(self, materials, |flags| Records::indexed(vec![flags; materials.len()], which))
    }
}
