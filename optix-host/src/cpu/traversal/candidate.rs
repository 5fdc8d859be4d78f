//! What becomes of a candidate: the one place where the interval, culling, any-hit programs and acceptance are, for every kind of
//! primitive. A test finds where a ray meets a primitive, and submits that.

use super::flags::{Verdict, any_hit_verdict, face_culled};
use super::gas::Gas;
use super::path::InstancePath;
use super::program::{AnyHit, Candidate, PrimitiveContext, Programs};
use super::ray::RayQuery;
use super::state::{CommittedHit, TraceState, sbt_index};
use super::trace::Space;
use crate::scene::InstanceFlags;

/// What holds for all primitives of a structure: the ray in its space, and what the instances above it say.
#[derive(Clone, Copy)]
pub struct InstanceContext<'s> {
    pub query: &'s RayQuery,
    /// The query's, but not negative.
    pub tmin: f32,
    pub space: &'s Space,
    /// Those of the innermost instance (guide 5.4).
    pub flags: InstanceFlags,
    /// The sum over all instances.
    pub sbt_offset: u32,
}

impl<'s> InstanceContext<'s> {
    /// What programs are told of a primitive.
    pub fn of_primitive(
        &self,
        gas: &'s Gas,
        path: &'s InstancePath<'s>,
        primitive: u32,
        record: u32,
    ) -> PrimitiveContext<'s> {
        PrimitiveContext {
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
pub struct PotentialHit {
    pub t: f32,
    pub hit_kind: u8,
    pub attributes: [u32; 8],
    /// Counted over all inputs of the GAS.
    pub primitive: u32,
    /// Its SBT record in the GAS.
    pub record: u32,
    /// See [`CommittedHit::slot`].
    pub slot: u32,
}

/// Takes the hits that tests of one structure's primitives find.
pub struct HitSink<'r, 'a> {
    pub gas: &'a Gas,
    pub context: InstanceContext<'r>,
    pub path: &'r InstancePath<'a>,
    pub state: &'r mut TraceState<'a>,
}

impl<'a> HitSink<'_, 'a> {
    /// What the flags say of primitives with this record.
    #[inline(always)]
    pub fn verdict(&self, record: u32) -> Verdict {
        any_hit_verdict(self.gas.flags_of(record), self.context.flags, self.context.query.flags)
    }

    /// Whether a primitive of a built-in kind shows its front to the ray, after the instance's flip; `None` if it is culled for that.
    #[inline(always)]
    pub fn facing(&self, record: u32, front: bool) -> Option<bool> {
        let (geometry, instance) = (self.gas.flags_of(record), self.context.flags);
        let front = front != instance.contains(InstanceFlags::FLIP_TRIANGLE_FACING);
        (!face_culled(geometry, instance, self.context.query.flags, front)).then_some(front)
    }

    /// Whether a hit at `t` may become the closest; if not, there is no need to submit it.
    #[inline(always)]
    pub fn admits(&self, t: f32, primitive: u32) -> bool {
        self.state.admits(t, self.path, primitive)
    }

    /// Accepts an admitted hit, or asks the any-hit program; tells whether it was accepted.
    #[inline]
    pub fn submit(&mut self, hit: PotentialHit, verdict: Verdict, programs: &mut dyn Programs) -> bool {
        let PotentialHit { t, hit_kind, attributes, primitive, record, slot } = hit;
        let answer = match verdict {
            Verdict::AnyHit => programs.any_hit(&Candidate {
                context: self.context.of_primitive(self.gas, self.path, primitive, record),
                t,
                hit_kind,
                attributes,
                slot,
            }),
            _ => AnyHit::Accept,
        };
        let (gas, instance_offset) = (self.gas, self.context.sbt_offset);
        self.state.commit(
            answer,
            CommittedHit { t, hit_kind, attributes, primitive, record, instance_offset, slot, gas },
            self.path,
        )
    }
}
