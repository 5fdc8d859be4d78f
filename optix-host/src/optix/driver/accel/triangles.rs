//! Triangles as OptiX takes them (guide 5.1).

use super::super::sys;
use super::build::RawInput;
use super::gas::{ToInput, count};
use super::records::RawRecords;
use super::staging::Upload;
use crate::error::DriverError as Error;
use crate::geometry::{BuildInput, PrimitiveArray, TriangleArray};

impl ToInput for TriangleArray {
    unsafe fn to_input(input: &BuildInput<Self>, upload: &mut impl Upload) -> Result<RawInput, Error> {
        let triangles = &**input.primitives();
        let mut array = sys::OptixBuildInputTriangleArray {
            num_vertices: count(triangles.vertices().len())?,
            vertex_format: sys::OptixVertexFormat::FLOAT3,
            vertex_stride_in_bytes: size_of::<[f32; 3]>() as u32,
            primitive_index_offset: input.primitive_index_offset(),
            ..Default::default()
        };
        if let Some(indices) = triangles.indices() {
            array.num_index_triplets = count(triangles.len())?;
            array.index_format = sys::OptixIndicesFormat::UNSIGNED_INT3;
            array.index_stride_in_bytes = size_of::<[u32; 3]>() as u32;
            // SAFETY: the caller promises the host data.
            array.index_buffer = unsafe { upload.elements(indices)? };
        }
        // SAFETY: as above.
        let records = unsafe { RawRecords::of(input.records(), upload)? };
        array.num_sbt_records = records.count;
        array.sbt_index_offset_buffer = records.indices;
        array.sbt_index_offset_size_in_bytes = records.index_size;
        // SAFETY: as above.
        let vertices = unsafe { upload.elements(triangles.vertices())? };
        Ok(RawInput::new(
            sys::OptixBuildInputType::TRIANGLES,
            Box::new([vertices]),
            records.flags,
            |union, vertex_buffers, flags| {
                union.triangle_array = sys::OptixBuildInputTriangleArray { vertex_buffers, flags, ..array }
            },
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::super::staging::Remembered;
    use super::*;
    use crate::geometry::{GeometryFlags, Records};

    const CORNERS: [[f32; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    const INDICES: [[u32; 3]; 2] = [[0, 1, 2], [2, 1, 3]];

    #[test]
    fn an_indexed_mesh_with_two_records() {
        let array = TriangleArray::new(CORNERS.to_vec(), Some(INDICES.to_vec())).unwrap();
        let flags = vec![GeometryFlags::DISABLE_ANYHIT, GeometryFlags::NONE];
        let input = BuildInput::new(array, Records::indexed(flags, vec![1, 0])).unwrap();
        let input = input.with_primitive_index_offset(7).unwrap();
        let mut memory = Remembered::default();
        // SAFETY: nothing is copied later.
        let raw = unsafe { TriangleArray::to_input(&input, &mut memory) }.unwrap();
        assert_eq!(raw.kind(), sys::OptixBuildInputType::TRIANGLES);
        assert_eq!(raw.flags(), [1, 0]);
        // SAFETY: the member of its kind.
        let array = unsafe { raw.union().triangle_array };
        assert_eq!((array.num_vertices, array.vertex_format.0, array.vertex_stride_in_bytes), (4, 8481, 12));
        assert_eq!((array.num_index_triplets, array.index_format.0, array.index_stride_in_bytes), (2, 8451, 12));
        assert_eq!(array.num_sbt_records, 2);
        let [size, stride] = [array.sbt_index_offset_size_in_bytes, array.sbt_index_offset_stride_in_bytes];
        assert_eq!(([size, stride], array.primitive_index_offset), ([4, 0], 7));
        assert_eq!((array.transform_format.0, array.pre_transform), (0, 0));
        assert_eq!(memory.at::<[u32; 3]>(array.index_buffer), INDICES);
        assert_eq!(memory.at::<u32>(array.sbt_index_offset_buffer), [1, 0]);
        let [vertices] = raw.buffers() else { panic!("one motion key") };
        assert_eq!(memory.at::<[f32; 3]>(*vertices), CORNERS);
        assert_eq!((array.vertex_buffers, array.flags), (raw.buffers().as_ptr(), raw.flags().as_ptr()));
    }

    #[test]
    fn triangles_without_indices_and_with_one_record() {
        let array = TriangleArray::new(CORNERS[..3].to_vec(), None).unwrap();
        let input = BuildInput::new(array, Records::one(GeometryFlags::DISABLE_ANYHIT)).unwrap();
        // SAFETY: nothing is copied later.
        let raw = unsafe { TriangleArray::to_input(&input, &mut Remembered::default()) }.unwrap();
        // SAFETY: the member of its kind.
        let array = unsafe { raw.union().triangle_array };
        assert_eq!((array.num_vertices, array.num_index_triplets, array.index_format.0), (3, 0, 0));
        assert_eq!((array.index_buffer, array.index_stride_in_bytes), (0, 0));
        assert_eq!((array.num_sbt_records, array.sbt_index_offset_buffer), (1, 0));
        assert_eq!(array.sbt_index_offset_size_in_bytes, 0);
    }
}
