//! Records of a build input as OptiX takes them (guide 5.1).

use super::super::sys;
use super::gas::count;
use super::staging::Upload;
use crate::error::DriverError as Error;
use crate::geometry::{GeometryFlags, Records};

// The bits are OptiX's.
const _: () = {
    use sys::OptixGeometryFlags as Raw;
    assert!(GeometryFlags::NONE.bits() == Raw::NONE.0);
    assert!(GeometryFlags::DISABLE_ANYHIT.bits() == Raw::DISABLE_ANYHIT.0);
    assert!(GeometryFlags::REQUIRE_SINGLE_ANYHIT_CALL.bits() == Raw::REQUIRE_SINGLE_ANYHIT_CALL.0);
    assert!(GeometryFlags::DISABLE_TRIANGLE_FACE_CULLING.bits() == Raw::DISABLE_TRIANGLE_FACE_CULLING.0);
};

/// The members of a build input that are about its records.
pub(super) struct RawRecords {
    pub count: u32,
    /// Of each record.
    pub flags: Box<[u32]>,
    /// The device address of a record index a primitive, and the size of one; both 0 with one record, where they say nothing.
    pub indices: u64,
    pub index_size: u32,
}

impl RawRecords {
    /// # Safety
    /// As [`Upload::upload`].
    pub(super) unsafe fn of(records: &Records, upload: &mut impl Upload) -> Result<Self, Error> {
        let flags: Box<[u32]> = records.flags().iter().map(|flags| flags.bits()).collect();
        let count = count(flags.len())?;
        Ok(match records.of_primitive().filter(|_| count > 1) {
            // SAFETY: the caller's.
            Some(indices) => Self { count, flags, indices: unsafe { upload.elements(indices)? }, index_size: 4 },
            None => Self { count, flags, indices: 0, index_size: 0 },
        })
    }
}
