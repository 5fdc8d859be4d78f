//! Build inputs of a GAS.

use super::{GeometryError, PrimitiveArray, Records};
use crate::error::BuildError;
use std::sync::Arc;

/// One build input: checked primitives with checked records. A clone shares the primitives.
#[derive(Debug)]
pub struct BuildInput<A> {
    primitives: Arc<A>,
    records: Records,
    primitive_index_offset: u32,
}

impl<A> Clone for BuildInput<A> {
    fn clone(&self) -> Self {
        let Self { primitives, records, primitive_index_offset } = self;
        Self {
            primitives: primitives.clone(),
            records: records.clone(),
            primitive_index_offset: *primitive_index_offset,
        }
    }
}

impl<A: PrimitiveArray> BuildInput<A> {
    /// Checks that these are records of these primitives.
    pub fn new(primitives: impl Into<Arc<A>>, records: Records) -> Result<Self, GeometryError> {
        let primitives = primitives.into();
        records.check(primitives.len())?;
        Ok(Self { primitives, records, primitive_index_offset: 0 })
    }

    /// With this added to the primitive indices that programs see.
    pub fn with_primitive_index_offset(self, offset: u32) -> Result<Self, GeometryError> {
        let primitives = self.primitives.len();
        // The last index, not their number, has to fit 32 bits.
        if offset as u64 + primitives as u64 > 1 << 32 {
            return Err(GeometryError::PrimitiveIndexOverflow { offset, primitives });
        }
        Ok(Self { primitive_index_offset: offset, ..self })
    }

    /// The primitives.
    pub fn primitives(&self) -> &Arc<A> {
        &self.primitives
    }

    /// Their records.
    pub fn records(&self) -> &Records {
        &self.records
    }

    /// What is added to the primitive indices that programs see.
    pub fn primitive_index_offset(&self) -> u32 {
        self.primitive_index_offset
    }
}

/// The most that one GAS may have over all build inputs (guide 12).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GasLimits {
    /// Primitives.
    pub primitives: usize,
    /// Hit-group records.
    pub records: usize,
}

impl GasLimits {
    pub(super) fn check<A: PrimitiveArray>(self, inputs: &[BuildInput<A>]) -> Result<(), BuildError> {
        let primitives = inputs.iter().map(|input| input.primitives.len()).sum();
        let records = inputs.iter().map(|input| input.records.flags().len()).sum();
        for (what, count, limit) in
            [("primitives", primitives, self.primitives), ("hit-group records", records, self.records)]
        {
            if count > limit {
                return Err(BuildError::TooMany { what, count, limit });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{GeometryFlags, TriangleArray};
    use super::*;

    fn input(triangles: usize, records: usize) -> BuildInput<TriangleArray> {
        let array = TriangleArray::new(vec![[0.0; 3]; 3 * triangles], None).unwrap();
        BuildInput::new(array, Records::indexed(vec![GeometryFlags::NONE; records], vec![0; triangles])).unwrap()
    }

    #[test]
    fn primitive_indices_fit_32_bits() {
        assert!(input(1, 1).with_primitive_index_offset(u32::MAX).is_ok(), "the last index still fits");
        let error = GeometryError::PrimitiveIndexOverflow { offset: u32::MAX, primitives: 2 };
        assert_eq!(input(2, 1).with_primitive_index_offset(u32::MAX).unwrap_err(), error);
    }

    #[test]
    fn limits_are_of_all_inputs_together() {
        let limits = GasLimits { primitives: 5, records: 4 };
        let check = |inputs: &[BuildInput<TriangleArray>]| limits.check(inputs);
        assert_eq!(check(&[input(2, 2), input(3, 2)]), Ok(()));
        assert_eq!(check(&[]), Ok(()));
        let too_many = |what, count, limit| Err(BuildError::TooMany { what, count, limit });
        assert_eq!(check(&[input(3, 1), input(3, 1)]), too_many("primitives", 6, 5));
        assert_eq!(check(&[input(1, 2), input(1, 3)]), too_many("hit-group records", 5, 4));
    }
}
