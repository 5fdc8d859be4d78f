//! Boxes of custom primitives (guide 5.1).

use super::super::context::Context;
use super::super::sys;
use super::build::RawInput;
use super::gas::{Input, check_keys, gas, place_keys, to_u32};
use super::records::Records;
use super::source::{Source, Staging};
use super::{Accel, AccelOptions};
use crate::error::DriverError as Error;

/// Boxes of custom primitives. Each box must enclose its primitive, at every time between two keys.
#[derive(Clone, Debug)]
pub struct AabbInput<'a> {
    /// Minimum and maximum as six floats, one list a motion key or one list. Each list has the same length.
    pub aabbs: Vec<Source<'a, [f32; 6]>>,
    /// The records.
    pub records: Records<'a>,
    /// Added to the primitive indices that programs see.
    pub primitive_index_offset: u32,
}

impl Accel {
    /// Builds a geometry acceleration structure of custom primitives, and returns when it is built.
    ///
    /// # Errors
    /// As [`Self::triangles`].
    pub fn aabbs(context: &Context, inputs: &[AabbInput<'_>], options: &AccelOptions) -> Result<Self, Error> {
        gas(context, inputs, options)
    }
}

impl Input for AabbInput<'_> {
    fn primitives(&self) -> Result<u32, Error> {
        to_u32(self.aabbs.first().map_or(0, Source::len))
    }

    fn records(&self) -> &Records<'_> {
        &self.records
    }

    fn check(&self, keys: usize) -> Result<(), Error> {
        check_keys("boxes of custom primitives", &self.aabbs, keys)
    }

    unsafe fn place(&self, staging: &mut Staging<'_>) -> Result<RawInput, Error> {
        // SAFETY: the caller promises the host data.
        let (sbt_buffer, sbt_size) = unsafe { self.records.place(staging)? };
        // SAFETY: as above.
        let aabbs = unsafe { place_keys(staging, &self.aabbs)? };
        if let Some(address) =
            aabbs.iter().find(|address| !address.is_multiple_of(sys::OPTIX_AABB_BUFFER_BYTE_ALIGNMENT))
        {
            let problem = format!("the device address {address:#x} is no multiple of 8");
            return Err(Error::invalid("boxes of custom primitives", problem, "align the boxes to 8 bytes"));
        }
        let array = sys::OptixBuildInputCustomPrimitiveArray {
            num_primitives: self.primitives()?,
            stride_in_bytes: size_of::<sys::OptixAabb>() as u32,
            num_sbt_records: to_u32(self.records.flags.len())?,
            sbt_index_offset_buffer: sbt_buffer,
            sbt_index_offset_size_in_bytes: sbt_size,
            primitive_index_offset: self.primitive_index_offset,
            ..Default::default()
        };
        Ok(RawInput::aabbs(array, aabbs, self.records.raw_flags()))
    }
}
