//! Records of a build input (guide 5.1).

use super::GeometryError;

/// What holds for all primitives of a record (`OptixGeometryFlags`, guide 5.1). A set, joined with `|`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct GeometryFlags(u32);

impl GeometryFlags {
    /// Any-hit programs may run several times for one primitive and ray.
    pub const NONE: Self = Self(0);
    /// Any-hit programs never run, unless an instance or the ray enforces it. Faster, even where there is none.
    pub const DISABLE_ANYHIT: Self = Self(1);
    /// Any-hit programs run at most once for a primitive and ray. May be slower on a GPU; the CPU never calls them twice.
    pub const REQUIRE_SINGLE_ANYHIT_CALL: Self = Self(2);
    /// Triangles are hit from both sides, whatever cull flags the ray has.
    pub const DISABLE_TRIANGLE_FACE_CULLING: Self = Self(4);

    /// Bits of `OptixGeometryFlags`.
    pub const fn bits(self) -> u32 {
        self.0
    }

    /// Whether all flags of the other are among these.
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }
}

impl core::ops::BitOr for GeometryFlags {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

/// The hit-group records of a build input, and which one each primitive has.
#[derive(Clone, Debug, PartialEq)]
pub struct Records {
    flags: Vec<GeometryFlags>,
    of_primitive: Option<Vec<u32>>,
}

impl Records {
    /// One record for all primitives.
    pub fn one(flags: GeometryFlags) -> Self {
        Self { flags: vec![flags], of_primitive: None }
    }

    /// A record for each of `flags`: primitive `i` has record `of_primitive[i]`, counted from 0 for each build input.
    pub fn indexed(flags: Vec<GeometryFlags>, of_primitive: Vec<u32>) -> Self {
        Self { flags, of_primitive: Some(of_primitive) }
    }

    /// Flags of each record.
    pub fn flags(&self) -> &[GeometryFlags] {
        &self.flags
    }

    /// The record of each primitive; none where one record is for all.
    pub fn of_primitive(&self) -> Option<&[u32]> {
        self.of_primitive.as_deref()
    }

    /// Whether these are records for so many primitives.
    pub(super) fn check(&self, primitives: usize) -> Result<(), GeometryError> {
        let records = self.flags.len();
        let Some(of_primitive) = &self.of_primitive else { return Ok(()) };
        if of_primitive.len() != primitives {
            return Err(GeometryError::RecordNumbers { primitives, numbers: of_primitive.len() });
        }
        match of_primitive.iter().position(|&record| record as usize >= records) {
            Some(primitive) => Err(GeometryError::NoSuchRecord { primitive, number: of_primitive[primitive], records }),
            None if records == 0 => Err(GeometryError::NoRecord),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_records_are_named() {
        let check = |records: usize, of_primitive: &[u32]| {
            Records::indexed(vec![GeometryFlags::NONE; records], of_primitive.to_vec()).check(3)
        };
        assert_eq!(Records::one(GeometryFlags::NONE).check(3), Ok(()));
        assert_eq!(check(3, &[0, 2, 1]), Ok(()));
        assert_eq!(check(1, &[0, 0, 0]), Ok(()));
        let error = GeometryError::NoSuchRecord { primitive: 1, number: 2, records: 2 };
        assert_eq!(check(2, &[0, 2, 1]), Err(error));
        assert_eq!(check(3, &[0, 1]), Err(GeometryError::RecordNumbers { primitives: 3, numbers: 2 }));
        assert_eq!(check(0, &[0; 3]), Err(GeometryError::NoSuchRecord { primitive: 0, number: 0, records: 0 }));
        assert_eq!(Records::indexed(vec![], vec![]).check(0), Err(GeometryError::NoRecord));
    }
}
