//! What a trace has found so far.

use super::flags::ray_flags;
use super::gas::Gas;
use super::ias::Accel;
use super::path::InstancePath;
use super::program::{AnyHit, Hit};
use super::ray::{PreparedRay, RayQuery};

/// A hit, with the numbers it is made of.
#[derive(Clone, Copy, Debug)]
pub struct CommittedHit<'a> {
    pub t: f32,
    pub hit_kind: u8,
    pub attributes: [u32; 8],
    /// Counted over all inputs of the GAS.
    pub primitive: u32,
    pub record: u32,
    pub instance_offset: u32,
    /// Where a triangle's corners are at hand: its block times 8, plus its lane. 0 for custom primitives.
    pub slot: u32,
    pub gas: &'a Gas,
}

/// The ray's interval and its closest hit.
#[derive(Debug)]
pub struct TraceState<'a> {
    tmin: f32,
    /// Shrinks to the closest accepted hit.
    pub tmax: f32,
    /// Set by `AnyHit::Terminate` and `TERMINATE_ON_FIRST_HIT`.
    pub ended: bool,
    first_hit_ends: bool,
    closest: Option<CommittedHit<'a>>,
    /// Where the closest hit is.
    at: InstancePath<'a>,
}

impl<'a> TraceState<'a> {
    #[inline(always)]
    pub fn new(query: &RayQuery, tmin: f32, root: &'a Accel) -> Self {
        let first_hit_ends = query.flags & ray_flags::TERMINATE_ON_FIRST_HIT != 0;
        let at = InstancePath::new(root);
        Self { tmin, tmax: query.tmax, ended: false, first_hit_ends, closest: None, at }
    }

    /// Whether a candidate at `t` may become the closest hit: it lies in the closed interval, and if it ties with the
    /// closest hit it comes before that in the order of instance path and primitive.
    #[inline]
    pub fn admits(&self, t: f32, path: &InstancePath<'_>, primitive: u32) -> bool {
        if self.ended || !(t >= self.tmin && t <= self.tmax) {
            return false;
        }
        match &self.closest {
            Some(hit) if t == hit.t => (path.indices(), primitive) < (self.at.indices(), hit.primitive),
            _ => true,
        }
    }

    /// Acts on an any-hit decision; tells whether the hit was accepted.
    #[inline]
    pub fn commit(&mut self, answer: AnyHit, hit: CommittedHit<'a>, path: &InstancePath<'a>) -> bool {
        if answer == AnyHit::Ignore {
            return false;
        }
        self.tmax = hit.t;
        self.ended = answer == AnyHit::Terminate || self.first_hit_ends;
        self.closest = Some(hit);
        self.at.set(path);
        true
    }

    /// The limit of depth after some of the scene was looked at, when it was `limit` and the interval ended at `before`.
    /// Negative infinity if the ray has ended.
    #[inline(always)]
    pub fn limit(&self, before: f32, limit: f32, prepared: &PreparedRay) -> f32 {
        match self.ended {
            true => f32::NEG_INFINITY,
            false if self.tmax < before => prepared.depth_max(self.tmax),
            false => limit,
        }
    }

    #[inline(always)]
    pub fn hit(&self, query: &RayQuery) -> Option<Hit<'a>> {
        let hit = self.closest.as_ref()?;
        Some(Hit {
            t: hit.t,
            hit_kind: hit.hit_kind,
            attributes: hit.attributes,
            primitive_index: hit.gas.primitive_index(hit.primitive),
            sbt_gas_index: hit.record,
            sbt_index: sbt_index(query, hit.instance_offset, hit.record),
            slot: hit.slot,
            gas: hit.gas,
            path: self.at,
        })
    }
}

/// The hit-group record (guide 7.3): instance offsets + GAS index * stride + offset. Below `2^32`, because the sum of
/// instance offsets has 28 bits and a GAS index 24.
#[inline]
pub fn sbt_index(query: &RayQuery, instance_offset: u32, record: u32) -> u32 {
    instance_offset + record * (query.sbt_stride & 15) + (query.sbt_offset & 15)
}
