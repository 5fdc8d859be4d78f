//! Tests of traversal and intersection, and what they share.

mod decisions;
mod far;
mod graph;
mod input;
mod numerics;
mod watertight;

use std::sync::Arc;

use super::*;
use crate::error::InstanceError;
use crate::geometry::{self, BuildInput, CustomPrimitiveArray, GeometryFlags, Records, TriangleArray};
use crate::scene::InstanceFlags;

/// Programs that take everything.
pub struct Opaque;

impl Programs for Opaque {
    fn any_hit(&mut self, _: &Candidate<'_>) -> AnyHit {
        AnyHit::Accept
    }

    fn intersect(&mut self, _: &PrimitiveContext<'_>, _: &mut Reporter<'_, '_>) {}
}

/// Programs that answer every any-hit call alike and write it down; custom primitives report the given hits.
pub struct Scripted {
    pub answer: AnyHit,
    pub calls: Vec<(u32, f32, u8, u32)>,
    pub reports: Vec<(f32, u8)>,
    pub accepted: Vec<bool>,
    pub sites: usize,
}

impl Scripted {
    pub fn new(answer: AnyHit) -> Self {
        Self { answer, calls: Vec::new(), reports: Vec::new(), accepted: Vec::new(), sites: 0 }
    }
}

impl Programs for Scripted {
    fn any_hit(&mut self, candidate: &Candidate<'_>) -> AnyHit {
        let context = &candidate.context;
        self.calls.push((context.primitive_index, candidate.t, candidate.hit_kind, context.sbt_index));
        self.answer
    }

    fn intersect(&mut self, _: &PrimitiveContext<'_>, reporter: &mut Reporter<'_, '_>) {
        self.sites += 1;
        for (t, kind) in self.reports.clone() {
            let accepted = reporter.report(self, t, kind, &[kind.into()]);
            self.accepted.push(accepted);
        }
    }
}

/// Any-hit off, on.
pub const OFF: GeometryFlags = GeometryFlags::DISABLE_ANYHIT;
pub const ON: GeometryFlags = GeometryFlags::NONE;

pub fn triangles(
    vertices: Vec<[f32; 3]>,
    indices: Option<Vec<[u32; 3]>>,
    flags: GeometryFlags,
) -> BuildInput<TriangleArray> {
    BuildInput::new(TriangleArray::new(vertices, indices).unwrap(), Records::one(flags)).unwrap()
}

pub fn custom(boxes: &[Aabb], flags: GeometryFlags) -> BuildInput<CustomPrimitiveArray> {
    let bounds = boxes.iter().map(|b| geometry::Aabb { min: b.min.into(), max: b.max.into() });
    BuildInput::new(CustomPrimitiveArray::new(bounds.collect()).unwrap(), Records::one(flags)).unwrap()
}

pub fn mesh(vertices: &[[f32; 3]], indices: &[[u32; 3]]) -> Accel {
    Gas::new(vec![triangles(vertices.to_vec(), Some(indices.to_vec()), OFF)]).unwrap().into()
}

/// Right triangles in planes `z = depth`, front towards `+z`, that rays down the `z` axis through (0.25, 0.25) hit.
pub fn stack(depths: &[f32], flags: GeometryFlags) -> Gas {
    let vertices = depths.iter().flat_map(|&z| [[0., 0., z], [1., 0., z], [0., 1., z]]).collect();
    Gas::new(vec![triangles(vertices, None, flags)]).unwrap()
}

/// From `z = 10` downwards, so that `t = 10 - z`.
pub fn down() -> RayQuery {
    RayQuery::new([0.25, 0.25, 10.0], [0.0, 0.0, -1.0])
}

pub fn shared(accel: impl Into<Accel>) -> Arc<Accel> {
    Arc::new(accel.into())
}

/// SplitMix64.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// In `[0, 1)`.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// In `[-1, 1)`.
    pub fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    pub fn sphere(&mut self) -> [f64; 3] {
        let (z, phi) = (self.signed(), std::f64::consts::TAU * self.unit());
        let r = (1.0 - z * z).sqrt();
        [r * phi.cos(), r * phi.sin(), z]
    }
}
