//! Custom primitives as OptiX takes them (guide 5.1).

use super::super::sys;
use super::build::RawInput;
use super::gas::{ToInput, count};
use super::records::RawRecords;
use super::staging::Upload;
use crate::error::DriverError as Error;
use crate::geometry::{Aabb, BuildInput, CustomPrimitiveArray, PrimitiveArray};

// The boxes are uploaded as they are.
const _: () = {
    assert!(size_of::<Aabb>() == size_of::<sys::OptixAabb>());
    assert!(core::mem::offset_of!(Aabb, min) == core::mem::offset_of!(sys::OptixAabb, min));
    assert!(core::mem::offset_of!(Aabb, max) == core::mem::offset_of!(sys::OptixAabb, max));
};

impl ToInput for CustomPrimitiveArray {
    unsafe fn to_input(input: &BuildInput<Self>, upload: &mut impl Upload) -> Result<RawInput, Error> {
        // SAFETY: the caller promises the host data.
        let records = unsafe { RawRecords::of(input.records(), upload)? };
        // SAFETY: as above. The copy is aligned to 256 bytes, more than `OPTIX_AABB_BUFFER_BYTE_ALIGNMENT`.
        let bounds = unsafe { upload.elements(input.primitives().bounds())? };
        let array = sys::OptixBuildInputCustomPrimitiveArray {
            num_primitives: count(input.primitives().len())?,
            stride_in_bytes: size_of::<sys::OptixAabb>() as u32,
            num_sbt_records: records.count,
            sbt_index_offset_buffer: records.indices,
            sbt_index_offset_size_in_bytes: records.index_size,
            primitive_index_offset: input.primitive_index_offset(),
            ..Default::default()
        };
        Ok(RawInput::new(
            sys::OptixBuildInputType::CUSTOM_PRIMITIVES,
            Box::new([bounds]),
            records.flags,
            |union, aabb_buffers, flags| {
                union.custom_primitive_array = sys::OptixBuildInputCustomPrimitiveArray { aabb_buffers, flags, ..array }
            },
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::super::staging::Remembered;
    use super::*;
    use crate::geometry::{GeometryFlags, Records};
    use glam::Vec3;

    #[test]
    fn boxes_and_records() {
        let bounds = [Aabb { min: Vec3::NEG_ONE, max: Vec3::ONE }, Aabb { min: Vec3::ZERO, max: Vec3::X }];
        let array = CustomPrimitiveArray::new(bounds.to_vec()).unwrap();
        let records = Records::indexed(vec![GeometryFlags::NONE, GeometryFlags::DISABLE_ANYHIT], vec![0, 1]);
        let input = BuildInput::new(array, records).unwrap().with_primitive_index_offset(3).unwrap();
        let mut memory = Remembered::default();
        // SAFETY: nothing is copied later.
        let raw = unsafe { CustomPrimitiveArray::to_input(&input, &mut memory) }.unwrap();
        assert_eq!(raw.kind(), sys::OptixBuildInputType::CUSTOM_PRIMITIVES);
        // SAFETY: the member of its kind.
        let array = unsafe { raw.union().custom_primitive_array };
        assert_eq!((array.num_primitives, array.stride_in_bytes, array.primitive_index_offset), (2, 24, 3));
        assert_eq!((array.num_sbt_records, array.sbt_index_offset_size_in_bytes), (2, 4));
        assert_eq!(memory.at::<u32>(array.sbt_index_offset_buffer), [0, 1]);
        assert_eq!(raw.flags(), [0, 1]);
        let [buffer] = raw.buffers() else { panic!("one motion key") };
        assert_eq!(memory.at::<[f32; 6]>(*buffer), [[-1., -1., -1., 1., 1., 1.], [0., 0., 0., 1., 0., 0.]]);
        assert_eq!((array.aabb_buffers, array.flags), (raw.buffers().as_ptr(), raw.flags().as_ptr()));
    }
}
