//! Geometry: triangles and boxes, checked when they are given.

use super::{GasMember, Material};
use crate::error::GeometryError;
use crate::limits::MAX_PRIMITIVES;
use glam::Vec3;
use optix_device_rs::attributes::{Custom, Geometry as GeometryKindOf, Triangles};
use optix_device_rs::pipeline::HasHitGroup;
use optix_device_rs::record::SbtRecord;
use std::marker::PhantomData;
use std::sync::Arc;

/// Triangles to be: positions in object space, and three indices per triangle or none.
///
/// A front face has its vertices counter-clockwise (guide 13.7).
#[derive(Clone, Copy, Debug)]
pub struct TriangleMesh<'a> {
    positions: &'a [Vec3],
    indices: Option<&'a [[u32; 3]]>,
}

impl<'a> TriangleMesh<'a> {
    /// Three positions in a row are a triangle.
    pub fn new(positions: &'a [Vec3]) -> Self {
        Self { positions, indices: None }
    }

    /// Three indices are a triangle.
    pub fn indices(mut self, indices: &'a [[u32; 3]]) -> Self {
        self.indices = Some(indices);
        self
    }
}

/// An axis-aligned box in object space.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Aabb {
    /// Least corner.
    pub min: Vec3,
    /// Greatest corner.
    pub max: Vec3,
}

/// Boxes to be: the bounds of custom primitives, one each.
#[derive(Clone, Copy, Debug)]
pub struct Boxes<'a>(
    /// Finite, `min <= max`; one without end reaches from `f32::MIN` to `f32::MAX`.
    pub &'a [Aabb],
);

/// Geometry of kind `G`, to be put into acceleration structures with a material. A clone is the same geometry.
pub struct Geometry<G> {
    pub(crate) data: Arc<GeometryData>,
    kind: PhantomData<fn(G)>,
}

impl<G> Clone for Geometry<G> {
    fn clone(&self) -> Self {
        Self { data: self.data.clone(), kind: PhantomData }
    }
}

/// Checked geometry.
pub(crate) enum GeometryData {
    Triangles { vertices: Vec<[f32; 3]>, indices: Option<Vec<[u32; 3]>> },
    Boxes(Vec<Aabb>),
}

impl GeometryData {
    /// How many primitives there are.
    pub fn primitives(&self) -> usize {
        match self {
            Self::Triangles { indices: Some(indices), .. } => indices.len(),
            Self::Triangles { vertices, indices: None } => vertices.len() / 3,
            Self::Boxes(boxes) => boxes.len(),
        }
    }
}

/// Something that becomes geometry.
pub trait IntoGeometry {
    /// Its kind.
    type Kind: GeometryKindOf;
    #[doc(hidden)]
    #[allow(private_interfaces)]
    fn check(self) -> Result<GeometryDataToken, GeometryError>;
}

/// Keeps the checked data out of the public interface.
#[doc(hidden)]
pub struct GeometryDataToken(GeometryData);

impl IntoGeometry for TriangleMesh<'_> {
    type Kind = Triangles;
    fn check(self) -> Result<GeometryDataToken, GeometryError> {
        if let Some(vertex) = self.positions.iter().position(|p| !p.is_finite()) {
            return Err(GeometryError::NonFiniteVertex { vertex, value: self.positions[vertex] });
        }
        let vertices = self.positions.len();
        if let Some(indices) = self.indices {
            for (triangle, corners) in indices.iter().enumerate() {
                if let Some(&index) = corners.iter().find(|&&i| i as usize >= vertices) {
                    return Err(GeometryError::IndexOutOfRange { triangle, index, vertices });
                }
            }
        } else if !vertices.is_multiple_of(3) {
            return Err(GeometryError::PartialTriangle { count: vertices });
        }
        let data = GeometryData::Triangles {
            vertices: self.positions.iter().map(|p| p.to_array()).collect(),
            indices: self.indices.map(<[_]>::to_vec),
        };
        counted("a triangle mesh", data)
    }
}

impl IntoGeometry for Boxes<'_> {
    type Kind = Custom;
    fn check(self) -> Result<GeometryDataToken, GeometryError> {
        for (index, &Aabb { min, max }) in self.0.iter().enumerate() {
            if !(min.is_finite() && max.is_finite() && min.cmple(max).all()) {
                return Err(GeometryError::BadBox { index, min, max });
            }
        }
        counted("custom geometry", GeometryData::Boxes(self.0.to_vec()))
    }
}

fn counted(what: &'static str, data: GeometryData) -> Result<GeometryDataToken, GeometryError> {
    match data.primitives() {
        0 => Err(GeometryError::Empty { what }),
        count if count > MAX_PRIMITIVES => Err(GeometryError::TooMany { count }),
        _ => Ok(GeometryDataToken(data)),
    }
}

impl<G: GeometryKindOf> Geometry<G> {
    /// Checks and copies what was given.
    pub(crate) fn of(geometry: impl IntoGeometry<Kind = G>) -> Result<Self, GeometryError> {
        let GeometryDataToken(data) = geometry.check()?;
        Ok(Self { data: Arc::new(data), kind: PhantomData })
    }

    /// This geometry with one material for all its primitives.
    pub fn with<P, Rec: SbtRecord>(&self, material: &Material<P, Rec>) -> GasMember<P, G>
    where
        P: HasHitGroup<Rec, G>,
    {
        GasMember::new(self, vec![material.scene], vec![(material.index, material.hitgroup::<G>())], None)
    }

    /// This geometry with a material per primitive: primitive `i` has `materials[which[i]]`.
    pub fn with_each<P, Rec: SbtRecord>(&self, materials: &[Material<P, Rec>], which: Vec<u32>) -> GasMember<P, G>
    where
        P: HasHitGroup<Rec, G>,
    {
        let scenes = materials.iter().map(|m| m.scene).collect();
        let records = materials.iter().map(|m| (m.index, m.hitgroup::<G>())).collect();
        GasMember::new(self, scenes, records, Some(which))
    }
}
