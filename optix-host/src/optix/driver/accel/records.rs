//! Records of a build input (guide 5.1).

use super::super::sys;
use super::source::{Source, Staging};
use crate::error::DriverError as Error;

/// What holds for all primitives of a record (guide 5.1). A set, joined with [`Self::with`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GeometryFlags(u32);

impl GeometryFlags {
    /// Any-hit programs may run several times for one primitive.
    pub const NONE: Self = Self(sys::OptixGeometryFlags::NONE.0);
    /// Any-hit programs never run. Faster, even where there is none.
    pub const DISABLE_ANYHIT: Self = Self(sys::OptixGeometryFlags::DISABLE_ANYHIT.0);
    /// Any-hit programs run at most once for a primitive and ray. May be slower.
    pub const REQUIRE_SINGLE_ANYHIT_CALL: Self = Self(sys::OptixGeometryFlags::REQUIRE_SINGLE_ANYHIT_CALL.0);
    /// Triangles are never culled by their facing.
    pub const DISABLE_TRIANGLE_FACE_CULLING: Self = Self(sys::OptixGeometryFlags::DISABLE_TRIANGLE_FACE_CULLING.0);

    /// Both together.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

/// The records of a build input.
#[derive(Clone, Debug)]
pub struct Records<'a> {
    /// One entry a record, at least one.
    pub flags: Vec<GeometryFlags>,
    /// Which record each primitive uses, below `flags.len()`. Needed with more than one record.
    pub indices: Option<SbtIndices<'a>>,
}

impl Records<'_> {
    /// One record for all primitives.
    pub fn one(flags: GeometryFlags) -> Self {
        Self { flags: vec![flags], indices: None }
    }
}

/// A record index a primitive.
#[derive(Clone, Copy, Debug)]
pub enum SbtIndices<'a> {
    /// Of 1 byte.
    U8(Source<'a, u8>),
    /// Of 2 bytes.
    U16(Source<'a, u16>),
    /// Of 4 bytes.
    U32(Source<'a, u32>),
}

impl Records<'_> {
    pub(super) fn check(&self, primitives: u32) -> Result<(), Error> {
        const WHAT: &str = "the records of a build input";
        let records = self.flags.len();
        let Some(indices) = &self.indices else {
            return match records {
                1 => Ok(()),
                _ => {
                    let problem = format!("{records} records and no record indices");
                    Err(Error::invalid(WHAT, problem, "give one record, or an index for each primitive (guide 5.1)"))
                }
            };
        };
        let (count, largest) = match indices {
            SbtIndices::U8(indices) => (indices.len(), largest(indices.on_host())),
            SbtIndices::U16(indices) => (indices.len(), largest(indices.on_host())),
            SbtIndices::U32(indices) => (indices.len(), largest(indices.on_host())),
        };
        if count != primitives as usize {
            let problem = format!("{count} record indices for {primitives} primitives");
            return Err(Error::invalid(WHAT, problem, "give an index a primitive"));
        }
        match largest {
            Some(index) if index as usize >= records => {
                let problem = format!("record index {index}, but there are {records} records");
                Err(Error::invalid(WHAT, problem, "count the records of each build input from 0 (guide 5.1)"))
            }
            _ if records == 0 => {
                Err(Error::invalid(WHAT, "there is no record", "give each build input at least one (guide 5.1)"))
            }
            _ => Ok(()),
        }
    }

    /// Address and size of an index, both 0 with one record, where the indices say nothing.
    ///
    /// # Safety
    /// As [`Staging::place`].
    pub(super) unsafe fn place(&self, staging: &mut Staging<'_>) -> Result<(u64, u32), Error> {
        let Some(indices) = self.indices.as_ref().filter(|_| self.flags.len() > 1) else {
            return Ok((0, 0));
        };
        Ok(match indices {
            // SAFETY: the caller promises the host data.
            SbtIndices::U8(indices) => (unsafe { staging.place(indices)? }, 1),
            // SAFETY: as above.
            SbtIndices::U16(indices) => (unsafe { staging.place(indices)? }, 2),
            // SAFETY: as above.
            SbtIndices::U32(indices) => (unsafe { staging.place(indices)? }, 4),
        })
    }

    pub(super) fn raw_flags(&self) -> Box<[u32]> {
        self.flags.iter().map(|flags| flags.0).collect()
    }
}

/// The largest of the values, where the host has them.
pub(super) fn largest<T: Copy + Ord + Into<u32>>(values: Option<&[T]>) -> Option<u32> {
    values?.iter().copied().max().map(Into::into)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn record_indices_are_checked() {
        let records = |count: usize, indices: Option<&[u8]>| {
            let indices = indices.map(|indices| SbtIndices::U8(Source::host(indices)));
            Records { flags: vec![GeometryFlags::NONE; count], indices }.check(3).is_ok()
        };
        assert!(records(1, None));
        assert!(records(3, Some(&[0, 2, 1])));
        assert!(!records(2, Some(&[0, 2, 1])));
        assert!(!records(3, Some(&[0, 1])));
        assert!(!records(2, None));
        assert!(!records(0, None));
        assert!(!records(0, Some(&[0, 0, 0])));
    }
}
