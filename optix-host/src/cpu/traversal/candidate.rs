//! What becomes of a candidate: the one place where the interval, culling, any-hit programs and acceptance are, for every kind of
//! primitive. A test finds where a ray meets a primitive, and offers that.

use super::flags::{Verdict, any_hit_verdict, face_culled};
use super::gas::Gas;
use super::path::InstancePath;
use super::program::{AnyHit, Candidate, Programs, Site};
use super::ray::RayQuery;
use super::state::{Found, State, sbt_index};
use super::trace::Space;
use crate::scene::InstanceFlags;

/// A space and what the instances above it say.
#[derive(Clone, Copy)]
pub struct Place<'s> {
    pub query: &'s RayQuery,
    /// The query's, but not negative.
    pub tmin: f32,
    pub space: &'s Space,
    /// Those of the innermost instance (guide 5.4).
    pub flags: InstanceFlags,
    /// The sum over all instances.
    pub sbt_offset: u32,
}

impl<'s> Place<'s> {
    /// What programs are told of a primitive.
    pub fn site(&self, gas: &'s Gas, path: &'s InstancePath<'s>, primitive: u32, record: u32) -> Site<'s> {
        Site {
            primitive_index: gas.primitive_index(primitive),
            sbt_gas_index: record,
            sbt_index: sbt_index(self.query, self.sbt_offset, record),
            gas,
            path,
            query: self.query,
            object_ray: self.space.ray,
        }
    }
}

/// Where a test found that a ray meets a primitive.
pub struct Offer {
    pub t: f32,
    pub hit_kind: u8,
    pub attributes: [u32; 8],
    /// Counted over all inputs of the GAS.
    pub primitive: u32,
    /// Its SBT record in the GAS.
    pub record: u32,
    /// See [`Found::slot`].
    pub slot: u32,
}

/// Takes what tests of one structure's primitives offer.
pub struct Sink<'r, 'a> {
    pub gas: &'a Gas,
    pub place: Place<'r>,
    pub path: &'r InstancePath<'a>,
    pub state: &'r mut State<'a>,
}

impl<'a> Sink<'_, 'a> {
    /// What the flags say of primitives with this record.
    #[inline(always)]
    pub fn verdict(&self, record: u32) -> Verdict {
        any_hit_verdict(self.gas.flags_of(record), self.place.flags, self.place.query.flags)
    }

    /// Whether a primitive of a built-in kind shows its front to the ray, after the instance's flip; `None` if it is culled for that.
    #[inline(always)]
    pub fn facing(&self, record: u32, front: bool) -> Option<bool> {
        let (geometry, instance) = (self.gas.flags_of(record), self.place.flags);
        let front = front != instance.contains(InstanceFlags::FLIP_TRIANGLE_FACING);
        (!face_culled(geometry, instance, self.place.query.flags, front)).then_some(front)
    }

    /// Whether a hit at `t` may become the closest; if not, there is no need to offer it.
    #[inline(always)]
    pub fn admits(&self, t: f32, primitive: u32) -> bool {
        self.state.admits(t, self.path, primitive)
    }

    /// Accepts an admitted hit, or asks the any-hit program; tells whether it was accepted.
    #[inline]
    pub fn take(&mut self, offer: Offer, verdict: Verdict, programs: &mut dyn Programs) -> bool {
        let Offer { t, hit_kind, attributes, primitive, record, slot } = offer;
        let answer = match verdict {
            Verdict::AnyHit => programs.any_hit(&Candidate {
                site: self.place.site(self.gas, self.path, primitive, record),
                t,
                hit_kind,
                attributes,
                slot,
            }),
            _ => AnyHit::Accept,
        };
        let (gas, instance_offset) = (self.gas, self.place.sbt_offset);
        self.state.settle(
            answer,
            Found { t, hit_kind, attributes, primitive, record, instance_offset, slot, gas },
            self.path,
        )
    }
}
