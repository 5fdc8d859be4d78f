//! Geometry acceleration structures.

use super::aabb::Aabb;
use super::bvh::{Bvh, WIDTH};
use super::collapse::Shape;
use super::flags::GeometryFlags;
use super::triangle::Block;
use crate::error::BuildError;
use glam::DVec3;

/// How the primitives of a build input map to its SBT records (guide §5.1).
#[derive(Clone, Debug, PartialEq)]
pub struct SbtMapping {
    /// One entry per record; at least one.
    pub flags: Vec<GeometryFlags>,
    /// One record index per primitive; needed with more than one record.
    pub per_primitive: Option<Vec<u32>>,
}

impl SbtMapping {
    /// One record for all primitives.
    pub fn single(flags: GeometryFlags) -> Self {
        Self { flags: vec![flags], per_primitive: None }
    }
}

/// A triangle build input. The front of a triangle is the side from which its corners go counter-clockwise.
#[derive(Clone, Debug)]
pub struct TriangleInput {
    pub vertices: Vec<[f32; 3]>,
    /// Without it, every three vertices are a triangle.
    pub indices: Option<Vec<[u32; 3]>>,
    pub sbt: SbtMapping,
    /// Added to primitive indices when they are reported.
    pub primitive_index_offset: u32,
}

impl TriangleInput {
    fn len(&self) -> usize {
        self.indices.as_ref().map_or(self.vertices.len() / 3, Vec::len)
    }

    fn corners(&self, triangle: usize) -> [usize; 3] {
        match &self.indices {
            Some(indices) => indices[triangle].map(|i| i as usize),
            None => std::array::from_fn(|corner| 3 * triangle + corner),
        }
    }

    /// The corners of a triangle, counted without the offset.
    ///
    /// # Panics
    /// If there is no such triangle, or it has an index of no vertex.
    pub fn triangle(&self, triangle: usize) -> [[f32; 3]; 3] {
        self.corners(triangle).map(|i| self.vertices[i])
    }

    fn check(&self, input: usize) -> Result<(), BuildError> {
        let vertices = self.vertices.len();
        if self.indices.is_none() && !vertices.is_multiple_of(3) {
            return Err(BuildError::IncompleteTriangle { input, vertices });
        }
        for (triangle, indices) in self.indices.iter().flatten().enumerate() {
            if let Some(corner) = indices.iter().position(|&i| i as usize >= vertices) {
                return Err(BuildError::IndexOutOfRange { input, triangle, corner, index: indices[corner], vertices });
            }
        }
        match self.vertices.iter().position(|v| !v.iter().all(|x| x.is_finite())) {
            Some(vertex) => Err(BuildError::NonFiniteVertex { input, vertex, position: self.vertices[vertex] }),
            None => Ok(()),
        }
    }
}

/// A custom-primitive build input; an inverted box makes its primitive inactive.
#[derive(Clone, Debug)]
pub struct AabbInput {
    pub boxes: Vec<Aabb>,
    pub sbt: SbtMapping,
    /// Added to primitive indices when they are reported.
    pub primitive_index_offset: u32,
}

/// Most primitives, and most SBT records, of one structure.
const MAX_PRIMITIVES: usize = 1 << 29;
const MAX_RECORDS: usize = 1 << 24;

/// What a build input contributes.
#[derive(Clone, Copy, Debug)]
struct Part {
    first_primitive: u32,
    first_record: u32,
    primitive_index_offset: u32,
}

#[derive(Debug)]
pub(super) enum Content {
    /// A leaf's payload is the index of its block, and its number of triangles less 1 in the highest 3 of 31 bits.
    /// Without nodes, all blocks are tested, and all but the last are full.
    Triangles { blocks: Vec<Block>, inputs: Vec<TriangleInput> },
    /// A leaf's payload is the primitive, counted over all inputs.
    Custom { inputs: Vec<AabbInput> },
}

/// Bits of a triangle leaf's payload that hold the block.
const BLOCK_BITS: u32 = 28;

/// Up to this many triangles have no nodes: testing two blocks is less work than a node and the blocks it leads to.
pub(super) const DIRECT_TRIANGLES: usize = 2 * WIDTH;

/// The block of a triangle leaf and the mask of its lanes in use.
#[inline(always)]
pub(super) fn block_of(payload: u32) -> (usize, u32) {
    let last = payload >> BLOCK_BITS;
    ((payload & ((1 << BLOCK_BITS) - 1)) as usize, (2 << last) - 1)
}

/// A geometry acceleration structure over triangles or over custom primitives.
#[derive(Debug)]
pub struct Gas {
    pub(super) bvh: Bvh,
    pub(super) content: Content,
    /// Of each SBT record.
    flags: Vec<GeometryFlags>,
    /// SBT index of each primitive; empty if there is only one.
    records: Vec<u32>,
    parts: Vec<Part>,
    primitives: usize,
}

impl Gas {
    /// Builds over triangles. No inputs, and inputs without triangles, are legal; rays then miss.
    pub fn triangles(inputs: Vec<TriangleInput>) -> Result<Self, BuildError> {
        let mut table = Table::default();
        for (i, input) in inputs.iter().enumerate() {
            input.check(i)?;
            table.add(i, input.len(), &input.sbt, input.primitive_index_offset)?;
        }
        let triangles: Vec<[[f32; 3]; 3]> =
            inputs.iter().flat_map(|input| (0..input.len()).map(|i| input.triangle(i))).collect();
        let boxes: Vec<Aabb> = triangles.iter().map(|corners| Aabb::around(corners)).collect();
        let mut blocks = Vec::with_capacity(triangles.len() / 4);
        let bvh = if triangles.len() <= DIRECT_TRIANGLES {
            let all: Vec<u32> = (0..triangles.len() as u32).collect();
            blocks.extend(all.chunks(WIDTH).map(|primitives| Block::new(primitives, &triangles)));
            Bvh::bounds_only(&boxes)
        } else {
            Bvh::build(&boxes, TRIANGLE_LEAF, |primitives| {
                blocks.push(Block::new(primitives, &triangles));
                (blocks.len() - 1) as u32 | (primitives.len() as u32 - 1) << BLOCK_BITS
            })
        };
        blocks.shrink_to_fit();
        Ok(table.finish(bvh, Content::Triangles { blocks, inputs }))
    }

    /// Builds over custom primitives. No inputs, and inputs without boxes, are legal; rays then miss.
    pub fn custom(inputs: Vec<AabbInput>) -> Result<Self, BuildError> {
        let mut table = Table::default();
        for (i, input) in inputs.iter().enumerate() {
            if let Some(primitive) = input.boxes.iter().position(|b| !b.is_finite()) {
                let Aabb { min, max } = input.boxes[primitive];
                return Err(BuildError::NonFiniteBox { input: i, primitive, min, max });
            }
            table.add(i, input.boxes.len(), &input.sbt, input.primitive_index_offset)?;
        }
        let boxes: Vec<Aabb> = inputs.iter().flat_map(|input| input.boxes.iter().copied()).collect();
        let bvh = Bvh::build(&boxes, SINGLE_LEAF, |primitives| primitives[0]);
        Ok(table.finish(bvh, Content::Custom { inputs }))
    }

    /// The smallest box around all active primitives.
    pub fn bounds(&self) -> Aabb {
        self.bvh.bounds
    }

    /// Primitives of all build inputs.
    pub fn primitive_count(&self) -> usize {
        self.primitives
    }

    /// SBT records of all build inputs.
    pub fn record_count(&self) -> usize {
        self.flags.len()
    }

    /// The flags of an SBT record, or `None` if there is no such record.
    pub fn geometry_flags(&self, sbt_gas_index: u32) -> Option<GeometryFlags> {
        self.flags.get(sbt_gas_index as usize).copied()
    }

    pub fn is_triangles(&self) -> bool {
        matches!(self.content, Content::Triangles { .. })
    }

    /// The corners, in object space, of the triangle with this reported primitive index in the build input that
    /// `sbt_gas_index` belongs to (guide §13.9): NaN for one without area. `None` if there is none, or if these are custom
    /// primitives.
    pub fn triangle_vertices(&self, sbt_gas_index: u32, primitive_index: u32) -> Option<[[f32; 3]; 3]> {
        let Content::Triangles { inputs, .. } = &self.content else { return None };
        let (input, local) = self.locate(sbt_gas_index, primitive_index)?;
        let corners = (local < inputs[input].len()).then(|| inputs[input].triangle(local))?;
        Some(if has_area(&corners) { corners } else { [[f32::NAN; 3]; 3] })
    }

    /// The box, in object space, of the custom primitive with this reported index; see [`Gas::triangle_vertices`].
    pub fn custom_box(&self, sbt_gas_index: u32, primitive_index: u32) -> Option<Aabb> {
        let Content::Custom { inputs, .. } = &self.content else { return None };
        let (input, local) = self.locate(sbt_gas_index, primitive_index)?;
        inputs[input].boxes.get(local).copied()
    }

    /// The corners of the triangle in a lane of a block; see [`Found::slot`](super::state::Found::slot).
    #[inline]
    pub(super) fn triangle_in(&self, slot: u32) -> Option<[[f32; 3]; 3]> {
        let Content::Triangles { blocks, .. } = &self.content else { return None };
        Some(blocks.get(slot as usize / WIDTH)?.triangle(slot as usize % WIDTH))
    }

    /// Heap bytes of nodes, blocks and tables, and of the inputs, which are kept for the accessors.
    pub fn memory_bytes(&self) -> usize {
        let content = match &self.content {
            Content::Triangles { blocks, inputs } => {
                let input = |i: &TriangleInput| {
                    size_of_val(&i.vertices[..]) + i.indices.as_ref().map_or(0, |x| size_of_val(&x[..]))
                };
                size_of_val(&blocks[..]) + inputs.iter().map(input).sum::<usize>()
            }
            Content::Custom { inputs } => inputs.iter().map(|i| size_of_val(&i.boxes[..])).sum(),
        };
        let tables = size_of_val(&self.flags[..]) + size_of_val(&self.records[..]) + size_of_val(&self.parts[..]);
        self.bvh.memory_bytes() + content + tables
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

    fn locate(&self, sbt_gas_index: u32, primitive_index: u32) -> Option<(usize, usize)> {
        if sbt_gas_index as usize >= self.flags.len() {
            return None;
        }
        let input = self.parts.partition_point(|p| p.first_record <= sbt_gas_index) - 1;
        let local = primitive_index.checked_sub(self.parts[input].primitive_index_offset)?;
        Some((input, local as usize))
    }
}

/// Whether the corners span a triangle.
fn has_area(corners: &[[f32; 3]; 3]) -> bool {
    let [a, b, c] = corners.map(|corner| DVec3::from_array(corner.map(f64::from)));
    (b - a).cross(c - a) != DVec3::ZERO
}

/// A block is about as much work as a node.
const TRIANGLE_LEAF: Shape = Shape { leaf_size: WIDTH as u32, leaf_cost: 1.0 };
/// Every primitive in a slot of its own: the slot's box is the primitive's.
pub(super) const SINGLE_LEAF: Shape = Shape { leaf_size: 1, leaf_cost: 1.0 };

/// Numbers primitives and records over all inputs.
#[derive(Default)]
struct Table {
    parts: Vec<Part>,
    flags: Vec<GeometryFlags>,
    /// SBT index in the structure, per primitive.
    records: Vec<u32>,
}

impl Table {
    fn add(&mut self, input: usize, primitives: usize, sbt: &SbtMapping, offset: u32) -> Result<(), BuildError> {
        let records = sbt.flags.len();
        if records == 0 {
            return Err(BuildError::NoSbtRecord { input });
        }
        let (all_records, all_primitives) = (self.flags.len() + records, self.records.len() + primitives);
        if all_records > MAX_RECORDS {
            return Err(BuildError::TooMany { what: "SBT records", count: all_records, limit: MAX_RECORDS });
        }
        if all_primitives > MAX_PRIMITIVES {
            return Err(BuildError::TooMany { what: "primitives", count: all_primitives, limit: MAX_PRIMITIVES });
        }
        if offset as usize + primitives > 1 << 32 {
            return Err(BuildError::PrimitiveIndexOverflow { input, offset, primitives });
        }
        let first_record = self.flags.len() as u32;
        self.parts.push(Part {
            first_primitive: self.records.len() as u32,
            first_record,
            primitive_index_offset: offset,
        });
        match &sbt.per_primitive {
            None if records > 1 => return Err(BuildError::NoPerPrimitiveIndex { input, records }),
            None => self.records.resize(all_primitives, first_record),
            Some(indices) if indices.len() != primitives => {
                return Err(BuildError::PerPrimitiveLength { input, primitives, indices: indices.len() });
            }
            Some(indices) => {
                if let Some(primitive) = indices.iter().position(|&i| i as usize >= records) {
                    let index = indices[primitive];
                    return Err(BuildError::SbtIndexOutOfRange { input, primitive, index, records });
                }
                self.records.extend(indices.iter().map(|i| first_record + i));
            }
        }
        self.flags.extend(&sbt.flags);
        Ok(())
    }

    fn finish(mut self, bvh: Bvh, content: Content) -> Gas {
        let primitives = self.records.len();
        if self.flags.len() <= 1 {
            self.records = Vec::new();
        }
        Gas { bvh, content, flags: self.flags, records: self.records, parts: self.parts, primitives }
    }
}
