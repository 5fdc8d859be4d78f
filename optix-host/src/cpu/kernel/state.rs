//! What a trace has found so far.

use super::flags::ray_flags;
use super::gas::Gas;
use super::path::InstancePath;
use super::program::{AnyHit, Hit};
use super::ray::RayQuery;

/// A hit, with the numbers it is made of.
#[derive(Clone, Copy, Debug)]
pub struct Found<'a> {
    pub t: f32,
    pub hit_kind: u8,
    pub attributes: [u32; 8],
    /// Counted over all inputs of the GAS.
    pub primitive: u32,
    pub record: u32,
    pub instance_offset: u32,
    pub gas: &'a Gas,
}

/// The ray's interval and its closest hit.
#[derive(Debug)]
pub struct State<'a> {
    pub query: RayQuery,
    /// Shrinks to the closest accepted hit.
    pub tmax: f32,
    /// Set by `AnyHit::Terminate` and `TERMINATE_ON_FIRST_HIT`.
    pub ended: bool,
    closest: Option<Found<'a>>,
    /// Where the closest hit is.
    at: InstancePath<'a>,
}

impl<'a> State<'a> {
    #[inline(always)]
    pub fn new(query: RayQuery, at: InstancePath<'a>) -> Self {
        Self { query, tmax: query.tmax, ended: false, closest: None, at }
    }

    /// Whether a candidate at `t` may become the closest hit: it lies in the closed interval, and if it ties with the
    /// closest hit it comes before that in the order of instance path and primitive.
    #[inline]
    pub fn admits(&self, t: f32, path: &InstancePath<'_>, primitive: u32) -> bool {
        if self.ended || !(t >= self.query.tmin && t <= self.tmax) {
            return false;
        }
        match &self.closest {
            Some(found) if t == found.t => (path.indices(), primitive) < (self.at.indices(), found.primitive),
            _ => true,
        }
    }

    /// Acts on an any-hit decision; tells whether `found` was accepted.
    #[inline]
    pub fn settle(&mut self, answer: AnyHit, found: Found<'a>, path: &InstancePath<'a>) -> bool {
        if answer == AnyHit::Ignore {
            return false;
        }
        self.tmax = found.t;
        self.ended = answer == AnyHit::Terminate || self.query.flags & ray_flags::TERMINATE_ON_FIRST_HIT != 0;
        self.closest = Some(found);
        self.at.set(path);
        true
    }

    #[inline(always)]
    pub fn into_hit(self) -> Option<Hit<'a>> {
        let found = self.closest?;
        Some(Hit {
            t: found.t,
            hit_kind: found.hit_kind,
            attributes: found.attributes,
            primitive_index: found.gas.primitive_index(found.primitive),
            sbt_gas_index: found.record,
            sbt_index: sbt_index(&self.query, found.instance_offset, found.record),
            gas: found.gas,
            path: self.at,
        })
    }
}

/// The hit-group record (guide §7.3): instance offsets + GAS index * stride + offset. Below `2^32`, because the sum of
/// instance offsets has 28 bits and a GAS index 24.
#[inline]
pub fn sbt_index(query: &RayQuery, instance_offset: u32, record: u32) -> u32 {
    instance_offset + record * (query.sbt_stride & 15) + (query.sbt_offset & 15)
}
