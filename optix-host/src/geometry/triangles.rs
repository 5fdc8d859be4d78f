//! Triangles.

use super::{BuildInput, BuildInputs, GasPrimitive, GeometryError, IntoGeometry, PrimitiveArray};
use glam::Vec3;
use optix_device_rs::primitive::Triangles;

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

impl IntoGeometry for TriangleMesh<'_> {
    type Kind = Triangles;

    fn check(self) -> Result<TriangleArray, GeometryError> {
        let vertices = self.positions.iter().map(|p| p.to_array()).collect();
        TriangleArray::new(vertices, self.indices.map(<[_]>::to_vec))
    }
}

/// Checked triangles: coordinates are finite, and each index is of a vertex.
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleArray {
    vertices: Vec<[f32; 3]>,
    indices: Option<Vec<[u32; 3]>>,
}

impl TriangleArray {
    /// Checks vertices in object space. Without indices, every three of them are a triangle. No triangles at all are legal.
    pub fn new(vertices: Vec<[f32; 3]>, indices: Option<Vec<[u32; 3]>>) -> Result<Self, GeometryError> {
        if let Some(vertex) = vertices.iter().position(|v| !v.iter().all(|x| x.is_finite())) {
            return Err(GeometryError::NonFiniteVertex { vertex, value: vertices[vertex].into() });
        }
        let count = vertices.len();
        if u32::try_from(count).is_err() {
            return Err(GeometryError::TooManyVertices { count });
        }
        match &indices {
            None if !count.is_multiple_of(3) => return Err(GeometryError::PartialTriangle { count }),
            None => {}
            Some(indices) => {
                for (triangle, corners) in indices.iter().enumerate() {
                    if let Some(&index) = corners.iter().find(|&&index| index as usize >= count) {
                        return Err(GeometryError::IndexOutOfRange { triangle, index, vertices: count });
                    }
                }
            }
        }
        Ok(Self { vertices, indices })
    }

    /// The vertices.
    pub fn vertices(&self) -> &[[f32; 3]] {
        &self.vertices
    }

    /// Three vertices for each triangle; none where every three vertices are one.
    pub fn indices(&self) -> Option<&[[u32; 3]]> {
        self.indices.as_deref()
    }

    /// The corners of a triangle.
    ///
    /// # Panics
    /// If there is no such triangle.
    pub fn triangle(&self, triangle: usize) -> [[f32; 3]; 3] {
        let corners = match &self.indices {
            Some(indices) => indices[triangle].map(|index| index as usize),
            None => core::array::from_fn(|corner| 3 * triangle + corner),
        };
        corners.map(|vertex| self.vertices[vertex])
    }
}

impl GasPrimitive for Triangles {
    type Array = TriangleArray;
}

impl PrimitiveArray for TriangleArray {
    type Primitive = Triangles;
    const NAME: &'static str = "a triangle mesh";

    fn inputs(inputs: Vec<BuildInput<Self>>) -> BuildInputs {
        BuildInputs::Triangles(inputs)
    }

    fn len(&self) -> usize {
        self.indices.as_ref().map_or(self.vertices.len() / 3, Vec::len)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f32; 3]; 3] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    #[test]
    fn wrong_triangles_are_named() {
        let array = |vertices: &[[f32; 3]], indices: Option<&[[u32; 3]]>| {
            TriangleArray::new(vertices.to_vec(), indices.map(<[_]>::to_vec))
        };
        assert_eq!(array(&CORNERS, Some(&[[0, 1, 2], [2, 1, 0]])).unwrap().triangle(1)[0], CORNERS[2]);
        assert_eq!(array(&CORNERS, None).unwrap().len(), 1);
        assert!(array(&[], None).unwrap().is_empty());
        assert!(array(&CORNERS[..1], Some(&[])).unwrap().is_empty());
        let cases = [
            (
                array(&CORNERS, Some(&[[0, 1, 2], [2, 3, 1]])),
                GeometryError::IndexOutOfRange { triangle: 1, index: 3, vertices: 3 },
            ),
            (array(&[], Some(&[[0, 0, 0]])), GeometryError::IndexOutOfRange { triangle: 0, index: 0, vertices: 0 }),
            (array(&CORNERS[..2], None), GeometryError::PartialTriangle { count: 2 }),
            (
                array(&[[0.0; 3], [0.0, f32::INFINITY, 0.0], [0.0; 3]], None),
                GeometryError::NonFiniteVertex { vertex: 1, value: Vec3::new(0.0, f32::INFINITY, 0.0) },
            ),
        ];
        for (result, error) in cases {
            assert_eq!(result.unwrap_err(), error);
        }
    }
}
