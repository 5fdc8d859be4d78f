//! Geometry acceleration structures.

use super::bvh::{Aabb, Bvh};
use super::primitive::Primitives;
use crate::error::BuildError;
use crate::geometry::{BuildInput, BuildInputs, GasLimits, GeometryFlags, PrimitiveArray, of_any_kind};
use crate::limits::{MAX_PRIMITIVES, MAX_RECORDS_OF_GAS};

const LIMITS: GasLimits = GasLimits { primitives: MAX_PRIMITIVES, records: MAX_RECORDS_OF_GAS };

/// What a build input contributes.
#[derive(Clone, Copy, Debug)]
struct InputRange {
    first_primitive: u32,
    first_record: u32,
    primitive_index_offset: u32,
}

/// A geometry acceleration structure over triangles or over custom primitives.
#[derive(Debug)]
pub struct Gas {
    pub(super) bvh: Bvh,
    pub(super) primitives: Primitives,
    /// Of each SBT record.
    flags: Vec<GeometryFlags>,
    /// SBT index of each primitive; empty if there is only one.
    records: Vec<u32>,
    parts: Vec<InputRange>,
    count: usize,
}

impl Gas {
    /// Builds over primitives of one kind. No inputs, and inputs without primitives, are legal; rays then miss.
    pub fn new(inputs: impl Into<BuildInputs>) -> Result<Self, BuildError> {
        let inputs = inputs.into();
        inputs.check(LIMITS)?;
        let table = Numbering::of(&inputs);
        let (bvh, primitives) = Primitives::build(inputs);
        Ok(table.finish(bvh, primitives))
    }

    /// The smallest box around all active primitives.
    pub fn bounds(&self) -> Aabb {
        self.bvh.bounds
    }

    /// Primitives of all build inputs.
    pub fn primitive_count(&self) -> usize {
        self.count
    }

    /// SBT records of all build inputs.
    pub fn record_count(&self) -> usize {
        self.flags.len()
    }

    /// The flags of an SBT record, or `None` if there is no such record.
    pub fn geometry_flags(&self, sbt_gas_index: u32) -> Option<GeometryFlags> {
        self.flags.get(sbt_gas_index as usize).copied()
    }

    /// Heap bytes of nodes, blocks and tables, and of the inputs, which are kept for the accessors.
    pub fn memory_bytes(&self) -> usize {
        let tables = size_of_val(&self.flags[..]) + size_of_val(&self.records[..]) + size_of_val(&self.parts[..]);
        self.bvh.memory_bytes() + self.primitives.memory_bytes() + tables
    }

    /// The index that programs see of a primitive counted over all inputs.
    #[inline]
    pub(super) fn primitive_index(&self, primitive: u32) -> u32 {
        let part = match &self.parts[..] {
            [only] => only,
            parts => &parts[parts.partition_point(|p| p.first_primitive <= primitive) - 1],
        };
        primitive - part.first_primitive + part.primitive_index_offset
    }

    /// The SBT index of a primitive counted over all inputs.
    #[inline(always)]
    pub(super) fn record_of(&self, primitive: u32) -> u32 {
        if self.records.is_empty() { 0 } else { self.records[primitive as usize] }
    }

    #[inline(always)]
    pub(super) fn flags_of(&self, record: u32) -> GeometryFlags {
        self.flags[record as usize]
    }

    /// The build input and the index in it of the primitive that programs know by these numbers, if there is such an input.
    pub(super) fn locate(&self, sbt_gas_index: u32, primitive_index: u32) -> Option<(usize, usize)> {
        if sbt_gas_index as usize >= self.flags.len() {
            return None;
        }
        let input = self.parts.partition_point(|p| p.first_record <= sbt_gas_index) - 1;
        let local = primitive_index.checked_sub(self.parts[input].primitive_index_offset)?;
        Some((input, local as usize))
    }
}

/// Numbers primitives and records over all inputs.
#[derive(Default)]
struct Numbering {
    parts: Vec<InputRange>,
    flags: Vec<GeometryFlags>,
    /// SBT index in the structure, per primitive.
    records: Vec<u32>,
}

impl Numbering {
    fn of(inputs: &BuildInputs) -> Self {
        let mut table = Self::default();
        of_any_kind!(inputs, inputs => table.add(inputs));
        table
    }

    fn add<A: PrimitiveArray>(&mut self, inputs: &[BuildInput<A>]) {
        for input in inputs {
            let (first_primitive, first_record) = (self.records.len() as u32, self.flags.len() as u32);
            self.parts.push(InputRange {
                first_primitive,
                first_record,
                primitive_index_offset: input.primitive_index_offset(),
            });
            match input.records().of_primitive() {
                None => self.records.resize(self.records.len() + input.primitives().len(), first_record),
                Some(records) => self.records.extend(records.iter().map(|record| first_record + record)),
            }
            self.flags.extend(input.records().flags());
        }
    }

    fn finish(mut self, bvh: Bvh, primitives: Primitives) -> Gas {
        let count = self.records.len();
        if self.flags.len() <= 1 {
            self.records = Vec::new();
        }
        Gas { bvh, primitives, flags: self.flags, records: self.records, parts: self.parts, count }
    }
}
