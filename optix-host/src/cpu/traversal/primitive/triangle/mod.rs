//! Triangles.

pub mod intersect;
mod simd;

pub use simd::TriangleSimd;

use super::{LeafRay, Leaves, Primitives};
use crate::cpu::traversal::bvh::{Aabb, Bvh, Shape, WIDTH};
use crate::cpu::traversal::candidate::PotentialHit;
use crate::cpu::traversal::flags::Verdict;
use crate::cpu::traversal::gas::Gas;
use crate::cpu::traversal::program::{Candidate, Hit};
use crate::cpu::traversal::ray::{SHRINK, ShearRay};
use crate::cpu::traversal::simd::Simd;
use crate::geometry::{BuildInput, PrimitiveArray, TriangleArray};
use glam::DVec3;
use intersect::{Block, Sheared, TriangleHit};
use optix_device_rs::prelude::HitKind;

/// Hit kinds of triangles.
pub const FRONT_FACE: u8 = HitKind::TRIANGLE_FRONT_FACE.get();
pub const BACK_FACE: u8 = HitKind::TRIANGLE_BACK_FACE.get();

/// Bits of a leaf's payload that hold the block.
const BLOCK_BITS: u32 = 28;

/// Up to this many triangles have no nodes: testing two blocks is less work than a node and the blocks it leads to.
const DIRECT_TRIANGLES: usize = 2 * WIDTH;

/// A block is about as much work as a node.
const LEAF: Shape = Shape { leaf_size: WIDTH as u32, leaf_cost: 1.0 };

/// The block of a leaf and the mask of its lanes in use.
#[inline(always)]
fn block_of(leaf: u32) -> (usize, u32) {
    let last = leaf >> BLOCK_BITS;
    ((leaf & ((1 << BLOCK_BITS) - 1)) as usize, (2 << last) - 1)
}

/// The triangles of a structure.
///
/// A leaf's payload is the index of its block, and its number of triangles less 1 in the highest 3 of 31 bits. Without nodes, all blocks
/// are tested, and all but the last are full.
#[derive(Debug)]
pub struct Triangles {
    blocks: Vec<Block>,
    inputs: Vec<BuildInput<TriangleArray>>,
}

/// Whether the corners span a triangle.
fn has_area(corners: &[[f32; 3]; 3]) -> bool {
    let [a, b, c] = corners.map(|corner| DVec3::from_array(corner.map(f64::from)));
    (b - a).cross(c - a) != DVec3::ZERO
}

impl Leaves for Triangles {
    type Array = TriangleArray;

    /// A leaf is a block.
    fn build(inputs: Vec<BuildInput<TriangleArray>>) -> (Bvh, Self) {
        let triangles: Vec<[[f32; 3]; 3]> = inputs
            .iter()
            .flat_map(|input| (0..input.primitives().len()).map(|i| input.primitives().triangle(i)))
            .collect();
        let boxes: Vec<Aabb> = triangles.iter().map(|corners| Aabb::around(corners)).collect();
        let mut blocks = Vec::with_capacity(triangles.len() / 4);
        let bvh = if triangles.len() <= DIRECT_TRIANGLES {
            let all: Vec<u32> = (0..triangles.len() as u32).collect();
            blocks.extend(all.chunks(WIDTH).map(|primitives| Block::new(primitives, &triangles)));
            Bvh::bounds_only(&boxes)
        } else {
            Bvh::build(&boxes, LEAF, |primitives| {
                blocks.push(Block::new(primitives, &triangles));
                (blocks.len() - 1) as u32 | (primitives.len() as u32 - 1) << BLOCK_BITS
            })
        };
        blocks.shrink_to_fit();
        (bvh, Self { blocks, inputs })
    }

    fn memory_bytes(&self) -> usize {
        let inputs = self.inputs.iter().map(|input| {
            let triangles = input.primitives();
            size_of_val(triangles.vertices()) + triangles.indices().map_or(0, size_of_val)
        });
        size_of_val(&self.blocks[..]) + inputs.sum::<usize>()
    }

    #[inline(always)]
    fn visit<S: Simd>(&self, simd: S, ray: &mut LeafRay<'_, '_>, leaf: u32, limit: f32) -> f32 {
        let (index, used) = block_of(leaf);
        self.visit_block(simd, ray, index, used, limit)
    }

    #[inline(always)]
    fn visit_all<S: Simd>(&self, simd: S, ray: &mut LeafRay<'_, '_>, mut limit: f32) {
        let mut left = ray.sink.gas.primitive_count();
        for index in 0..self.blocks.len() {
            let used = (1 << left.min(WIDTH)) - 1;
            left -= left.min(WIDTH);
            limit = self.visit_block(simd, ray, index, used, limit);
            if limit == f32::NEG_INFINITY {
                return;
            }
        }
    }
}

impl Triangles {
    /// Tests the triangles of a block that `used` has a bit for. Gives the new limit of depth, as [`Leaves::visit`] does.
    #[inline(always)]
    fn visit_block<S: Simd>(&self, simd: S, ray: &mut LeafRay<'_, '_>, index: usize, used: u32, limit: f32) -> f32 {
        let (block, prepared, before) = (&self.blocks[index], &ray.sink.context.space.prepared, ray.sink.state.tmax);
        if ray.far {
            visit_far_block(simd, ray, block, index, used, limit);
        } else {
            test_block(simd, ray, block, &prepared.shear, [prepared.depth_min, limit], index, used);
        }
        ray.sink.state.limit(before, limit, prepared)
    }
}

/// [`Triangles::visit_block`] where coordinates are so large that it is done with smaller ones.
#[cold]
#[inline(never)]
fn visit_far_block<S: Simd>(simd: S, ray: &mut LeafRay<'_, '_>, block: &Block, index: usize, used: u32, limit: f32) {
    let prepared = &ray.sink.context.space.prepared;
    let depths = [prepared.depth_min * SHRINK, limit * SHRINK];
    test_block(simd, ray, &block.shrunk(), &prepared.shear.shrunk(), depths, index, used);
}

/// Decides about the triangles of a block that `used` has a bit for.
#[inline(always)]
fn test_block<S: Simd>(
    simd: S,
    ray: &mut LeafRay<'_, '_>,
    block: &Block,
    shear: &ShearRay,
    depths: [f32; 2],
    index: usize,
    used: u32,
) {
    let mut sheared = Sheared::default();
    let mut lanes = simd.triangles(block, shear, depths, &mut sheared) & used;
    while lanes != 0 {
        let lane = lanes.trailing_zeros() as usize & (WIDTH - 1);
        lanes &= lanes - 1;
        let Some(hit) = intersect::hit(shear, intersect::lane_of(&sheared, lane)) else { continue };
        let primitive = block.primitives[lane];
        if ray.sink.admits(hit.t, primitive) {
            submit(ray, hit, primitive, (index * WIDTH + lane) as u32);
            if ray.sink.state.ended {
                return;
            }
        }
    }
}

/// Submits a hit that the interval admits, unless flags hide the triangle.
#[inline]
fn submit(ray: &mut LeafRay<'_, '_>, hit: TriangleHit, primitive: u32, slot: u32) {
    let record = ray.sink.gas.record_of(primitive);
    let verdict = ray.sink.verdict(record);
    if verdict == Verdict::Cull {
        return;
    }
    let Some(front) = ray.sink.facing(record, hit.front) else { return };
    let hit = PotentialHit {
        t: hit.t,
        hit_kind: if front { FRONT_FACE } else { BACK_FACE },
        attributes: [hit.u.to_bits(), hit.v.to_bits(), 0, 0, 0, 0, 0, 0],
        primitive,
        record,
        slot,
    };
    ray.sink.submit(hit, verdict, ray.programs);
}

impl Gas {
    /// The corners, in object space, of the triangle with this reported primitive index in the build input that
    /// `sbt_gas_index` belongs to (guide 13.9): NaN for one without area. `None` if there is none, or if these are other
    /// primitives.
    pub fn triangle_vertices(&self, sbt_gas_index: u32, primitive_index: u32) -> Option<[[f32; 3]; 3]> {
        let Primitives::Triangles(triangles) = &self.primitives else { return None };
        let (input, local) = self.locate(sbt_gas_index, primitive_index)?;
        let array = triangles.inputs[input].primitives();
        let corners = (local < array.len()).then(|| array.triangle(local))?;
        Some(if has_area(&corners) { corners } else { [[f32::NAN; 3]; 3] })
    }

    /// The corners of the triangle in a lane of a block; see [`CommittedHit::slot`](crate::cpu::traversal::state::CommittedHit::slot).
    #[inline]
    fn triangle_in(&self, slot: u32) -> Option<[[f32; 3]; 3]> {
        let Primitives::Triangles(triangles) = &self.primitives else { return None };
        Some(triangles.blocks.get(slot as usize / WIDTH)?.triangle(slot as usize % WIDTH))
    }
}

impl Candidate<'_> {
    /// The corners of the triangle, in object space; `None` for another primitive.
    pub fn triangle_vertices(&self) -> Option<[[f32; 3]; 3]> {
        self.context.gas.triangle_in(self.slot)
    }
}

impl Hit<'_> {
    /// The weights of a triangle's second and third corner.
    pub fn barycentrics(&self) -> [f32; 2] {
        [self.attributes[0], self.attributes[1]].map(f32::from_bits)
    }

    /// The corners of the triangle that was hit, in object space; `None` for another primitive.
    pub fn triangle_vertices(&self) -> Option<[[f32; 3]; 3]> {
        self.gas.triangle_in(self.slot)
    }
}
