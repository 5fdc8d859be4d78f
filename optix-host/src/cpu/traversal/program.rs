//! What a traversal asks of the shaders, and what it tells them.

use super::candidate::{HitSink, PotentialHit};
use super::flags::Verdict;
use super::gas::Gas;
use super::path::InstancePath;
use super::ray::{Ray, RayQuery};

/// What an any-hit program decides (guide 13.13).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnyHit {
    /// The candidate becomes the closest hit so far.
    Accept,
    /// The candidate is discarded.
    Ignore,
    /// As `Accept`, and traversal ends at once.
    Terminate,
}

/// The programs that run during traversal.
pub trait Programs {
    /// Called for candidates in `[tmin, tmax]`, at most once for a triangle and once for a report, in no promised order.
    fn any_hit(&mut self, candidate: &Candidate<'_>) -> AnyHit;

    /// Called for custom primitives whose box the ray meets. Calls [`Reporter::report`] for each hit found.
    fn intersect(&mut self, context: &PrimitiveContext<'_>, reporter: &mut Reporter<'_, '_>);

    /// Called for an instance whose box the ray meets and which it still misses: it is no ray in the instance's space, since an
    /// element of `object_ray` is not finite or its direction is 0. `path` leads to the instance.
    fn no_ray(&mut self, _path: &InstancePath<'_>, _object_ray: &Ray) {}
}

/// A primitive that a ray has come to.
#[derive(Clone, Copy, Debug)]
pub struct PrimitiveContext<'s> {
    /// With the build input's primitive index offset.
    pub primitive_index: u32,
    /// SBT index within the GAS (guide 7.3.2).
    pub sbt_gas_index: u32,
    /// Hit-group record of the whole SBT (guide 7.3).
    pub sbt_index: u32,
    pub gas: &'s Gas,
    pub path: &'s InstancePath<'s>,
    /// The ray as given to the trace.
    pub query: &'s RayQuery,
    /// The ray in the GAS's space, transformed in `f64` and rounded once.
    pub object_ray: Ray,
}

/// A hit before it is accepted.
#[derive(Clone, Copy, Debug)]
pub struct Candidate<'s> {
    pub context: PrimitiveContext<'s>,
    pub t: f32,
    /// 254 and 255 for the front and back of a triangle, otherwise as reported.
    pub hit_kind: u8,
    /// Triangles: `u`, `v` as bits, the weights of the second and third corner. Unused words are 0.
    pub attributes: [u32; 8],
    pub(super) slot: u32,
}

/// The closest accepted hit of a trace.
#[derive(Clone, Copy, Debug)]
pub struct Hit<'a> {
    /// In `[tmin, tmax]`, in multiples of the direction's length.
    pub t: f32,
    /// 254 and 255 for the front and back of a triangle, otherwise as reported.
    pub hit_kind: u8,
    /// Triangles: `u`, `v` as bits, the weights of the second and third corner. Unused words are 0.
    pub attributes: [u32; 8],
    /// With the build input's primitive index offset.
    pub primitive_index: u32,
    /// SBT index within the GAS (guide 7.3.2).
    pub sbt_gas_index: u32,
    /// Hit-group record of the whole SBT (guide 7.3).
    pub sbt_index: u32,
    pub(super) slot: u32,
    pub gas: &'a Gas,
    pub path: InstancePath<'a>,
}

/// Takes the hits that an intersection program finds on one primitive.
pub struct Reporter<'r, 'a> {
    pub(super) sink: HitSink<'r, 'a>,
    /// Counted over all inputs of the GAS.
    pub(super) primitive: u32,
    pub(super) record: u32,
    pub(super) verdict: Verdict,
}

impl Reporter<'_, '_> {
    /// Reports a hit (guide 13.4); tells whether it was accepted.
    ///
    /// It is not if `t` lies outside `[tmin, tmax]` or is NaN, if the any-hit program ignores it, if it ties with a hit
    /// that wins ties (see [`trace`](super::trace)), or if the ray has ended. Only the lowest 7 bits of `hit_kind` and
    /// the first 8 `attributes` count.
    pub fn report(&mut self, programs: &mut dyn Programs, t: f32, hit_kind: u8, attributes: &[u32]) -> bool {
        let Self { primitive, record, verdict, .. } = *self;
        if !self.sink.admits(t, primitive) {
            return false;
        }
        let mut words = [0; 8];
        words.iter_mut().zip(attributes).for_each(|(to, from)| *to = *from);
        let hit = PotentialHit { t, hit_kind: hit_kind & 0x7f, attributes: words, primitive, record, slot: 0 };
        self.sink.submit(hit, verdict, programs)
    }

    /// The end of the ray's interval: the closest hit accepted so far, else the trace's `tmax` (guide 13.5).
    pub fn tmax(&self) -> f32 {
        self.sink.state.tmax
    }

    /// Whether an accepted report has ended the ray; an intersection program should return then.
    pub fn is_terminated(&self) -> bool {
        self.sink.state.ended
    }
}
