//! Triangles (guide 5.1).

use super::super::context::Context;
use super::super::sys;
use super::build::RawInput;
use super::gas::{Input, check_keys, gas, place_keys, to_u32};
use super::records::{Records, largest};
use super::source::{Source, Staging};
use super::{Accel, AccelOptions};
use crate::error::DriverError as Error;

/// Vertex indices, three a triangle.
#[derive(Clone, Copy, Debug)]
pub enum Indices<'a> {
    /// Of 2 bytes.
    U16(Source<'a, [u16; 3]>),
    /// Of 4 bytes.
    U32(Source<'a, [u32; 3]>),
}

/// Triangles.
#[derive(Clone, Debug)]
pub struct TriangleInput<'a> {
    /// Positions, one list a motion key or one list. Each list has the same length.
    pub vertices: Vec<Source<'a, [f32; 3]>>,
    /// Without them, each three vertices are a triangle.
    pub indices: Option<Indices<'a>>,
    /// Row-major 3x4 matrix, applied to the vertices at build time.
    pub pre_transform: Option<&'a [f32; 12]>,
    /// The records.
    pub records: Records<'a>,
    /// Added to the primitive indices that programs see.
    pub primitive_index_offset: u32,
}

impl Accel {
    /// Builds a geometry acceleration structure of triangles, and returns when it is built.
    ///
    /// # Errors
    /// [`Error::Invalid`] for data that break a rule of guide 5.1, [`Error::Optix`] or [`Error::Cuda`] otherwise.
    pub fn triangles(context: &Context, inputs: &[TriangleInput<'_>], options: &AccelOptions) -> Result<Self, Error> {
        gas(context, inputs, options)
    }
}

impl Input for TriangleInput<'_> {
    fn primitives(&self) -> Result<u32, Error> {
        to_u32(match &self.indices {
            Some(Indices::U16(indices)) => indices.len(),
            Some(Indices::U32(indices)) => indices.len(),
            None => self.vertex_count() / 3,
        })
    }

    fn records(&self) -> &Records<'_> {
        &self.records
    }

    fn check(&self, keys: usize) -> Result<(), Error> {
        const WHAT: &str = "triangles";
        check_keys(WHAT, &self.vertices, keys)?;
        let vertices = self.vertex_count();
        to_u32(vertices)?;
        let largest = match &self.indices {
            Some(Indices::U16(indices)) => largest(indices.on_host().map(<[_]>::as_flattened)),
            Some(Indices::U32(indices)) => largest(indices.on_host().map(<[_]>::as_flattened)),
            None if vertices.is_multiple_of(3) => None,
            None => {
                let problem = format!("{vertices} vertices without indices");
                return Err(Error::invalid(WHAT, problem, "give three vertices a triangle, or indices"));
            }
        };
        match largest {
            Some(index) if index as usize >= vertices => {
                let problem = format!("vertex index {index}, but there are {vertices} vertices");
                Err(Error::invalid(WHAT, problem, "count the vertices from 0, for each build input"))
            }
            _ => Ok(()),
        }
    }

    unsafe fn place(&self, staging: &mut Staging<'_>) -> Result<RawInput, Error> {
        let mut array = sys::OptixBuildInputTriangleArray {
            num_vertices: to_u32(self.vertex_count())?,
            vertex_format: sys::OptixVertexFormat::FLOAT3,
            vertex_stride_in_bytes: size_of::<[f32; 3]>() as u32,
            primitive_index_offset: self.primitive_index_offset,
            ..Default::default()
        };
        if let Some(indices) = &self.indices {
            let (format, stride) = match indices {
                Indices::U16(_) => (sys::OptixIndicesFormat::UNSIGNED_SHORT3, size_of::<[u16; 3]>()),
                Indices::U32(_) => (sys::OptixIndicesFormat::UNSIGNED_INT3, size_of::<[u32; 3]>()),
            };
            array.num_index_triplets = self.primitives()?;
            (array.index_format, array.index_stride_in_bytes) = (format, stride as u32);
            array.index_buffer = match indices {
                // SAFETY: the caller promises the host data.
                Indices::U16(indices) => unsafe { staging.place(indices)? },
                // SAFETY: as above.
                Indices::U32(indices) => unsafe { staging.place(indices)? },
            };
        }
        if let Some(matrix) = self.pre_transform {
            array.transform_format = sys::OptixTransformFormat::MATRIX_FLOAT12;
            // SAFETY: the caller promises the host data. The copy is aligned to 256 bytes, more than the 16 that are asked for.
            array.pre_transform = unsafe { staging.place(&Source::host(matrix.as_slice()))? };
        }
        // SAFETY: the caller promises the host data.
        let (sbt_buffer, sbt_size) = unsafe { self.records.place(staging)? };
        array.num_sbt_records = to_u32(self.records.flags.len())?;
        (array.sbt_index_offset_buffer, array.sbt_index_offset_size_in_bytes) = (sbt_buffer, sbt_size);
        // SAFETY: as above.
        let vertices = unsafe { place_keys(staging, &self.vertices)? };
        Ok(RawInput::triangles(array, vertices, self.records.raw_flags()))
    }
}

impl TriangleInput<'_> {
    fn vertex_count(&self) -> usize {
        self.vertices.first().map_or(0, Source::len)
    }
}

#[cfg(test)]
mod tests {
    use super::super::records::GeometryFlags;
    use super::*;

    const TRIANGLE: [[f32; 3]; 3] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    fn input<'a>(vertices: &'a [[f32; 3]], indices: Option<&'a [[u32; 3]]>) -> TriangleInput<'a> {
        TriangleInput {
            vertices: vec![Source::host(vertices)],
            indices: indices.map(|indices| Indices::U32(Source::host(indices))),
            pre_transform: None,
            records: Records::one(GeometryFlags::NONE),
            primitive_index_offset: 0,
        }
    }

    #[test]
    fn vertex_indices_are_checked() {
        assert!(input(&TRIANGLE, Some(&[[0, 1, 2], [2, 1, 0]])).check(1).is_ok());
        let error = input(&TRIANGLE, Some(&[[0, 1, 3]])).check(1).unwrap_err();
        assert!(error.to_string().contains("vertex index 3"), "{error}");
        assert!(input(&TRIANGLE, None).check(1).is_ok());
        assert!(input(&TRIANGLE[..2], None).check(1).is_err());
        assert!(input(&[], None).check(1).is_ok());
        assert!(input(&[], Some(&[[0, 0, 0]])).check(1).is_err());
    }

    #[test]
    fn motion_keys_are_counted() {
        let mut moving = input(&TRIANGLE, None);
        assert!(moving.check(2).is_err());
        moving.vertices.push(Source::host(&TRIANGLE));
        assert!(moving.check(2).is_ok());
        moving.vertices[1] = Source::host(&[]);
        assert!(moving.check(2).is_err());
        assert!(TriangleInput { vertices: vec![], ..input(&[], None) }.check(1).is_err());
    }
}
