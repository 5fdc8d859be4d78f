//! Traversal.

use super::bvh::{Bvh, Child, Lanes, STACK};
use super::flags::{InstanceFlags, Verdict, any_hit_verdict, face_culled};
use super::gas::{Content, Gas, block_of};
use super::ias::{Accel, Ias};
use super::path::InstancePath;
use super::program::{AnyHit, Candidate, Hit, Programs, Reporter, Site};
use super::ray::{BoxRay, Frame, Ray, RayQuery};
#[cfg(target_arch = "x86_64")]
use super::simd::Avx2;
use super::simd::{Portable, Simd, Task};
use super::state::{Found, State, sbt_index};
use super::triangle::{self, Block, TriangleHit};

/// Hit kinds of triangles (`OptixHitKind`).
pub const FRONT_FACE: u8 = 254;
pub const BACK_FACE: u8 = 255;

/// Traces a ray (guide §13.2) and gives its closest accepted hit. No structure at all is a miss.
///
/// The interval `[tmin, tmax]` is closed. Hits at the same `t` are ordered by instance path (index by index from the
/// root) and then by primitive (counted over the build inputs of the GAS): the first wins, so the result does not
/// depend on the order of traversal, on the instruction set or on threads. A candidate that ties with the closest hit
/// but comes after it is dropped without an any-hit call; one that comes before it is offered to any-hit like any other.
/// A custom primitive's second report at the same `t` comes after its first.
///
/// Which candidates behind the final hit are offered to any-hit depends on the order of traversal, as the guide allows
/// (§13.4); that order is the same in every run.
///
/// Watertight within a GAS: see `triangle.rs`. Between instances nothing is promised, as in OptiX, because each has a
/// ray of its own.
#[inline]
pub fn trace<'a, P: Programs>(accel: Option<&'a Accel>, ray: &RayQuery, programs: &mut P) -> Option<Hit<'a>> {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = Avx2::detect() {
        return trace_with(simd, accel, ray, programs);
    }
    trace_with(Portable, accel, ray, programs)
}

/// [`trace`] with a given instruction set.
#[inline]
pub fn trace_with<'a, S: Simd, P: Programs>(
    simd: S,
    accel: Option<&'a Accel>,
    ray: &RayQuery,
    programs: &mut P,
) -> Option<Hit<'a>> {
    let accel = accel?;
    let query = RayQuery { tmin: ray.tmin.max(0.0), ..*ray };
    if ray.tmin.is_nan() || ray.tmax.is_nan() || query.tmin > query.tmax {
        return None;
    }
    let mut path = InstancePath::new(accel);
    let mut state = State::new(query, path);
    let here = Place {
        ray: Ray { origin: ray.origin, direction: ray.direction },
        exact: [ray.origin, ray.direction].map(|v| v.map(f64::from)),
        flags: InstanceFlags::NONE,
        sbt_offset: 0,
    };
    simd.run(Level { accel, here, state: &mut state, path: &mut path, programs });
    state.into_hit()
}

/// A space and what the instances above it say.
struct Place {
    ray: Ray,
    /// Origin and direction before rounding.
    exact: [[f64; 3]; 2],
    /// Those of the innermost instance (guide §5.4).
    flags: InstanceFlags,
    /// The sum over all instances.
    sbt_offset: u32,
}

/// Traversal of one structure of the graph.
struct Level<'t, 'a, P> {
    accel: &'a Accel,
    here: Place,
    state: &'t mut State<'a>,
    path: &'t mut InstancePath<'a>,
    programs: &'t mut P,
}

impl<P: Programs> Task for Level<'_, '_, P> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let (bvh, slack) = match self.accel {
            Accel::Gas(gas) => (&gas.bvh, 1.0),
            Accel::Ias(ias) => (&ias.bvh, ias.slack),
        };
        let Some(frame) = Frame::new(&self.here.ray, self.state.query.tmin, &bvh.bounds, slack) else { return };
        match self.accel {
            Accel::Gas(gas) => match &gas.content {
                Content::Triangles { blocks, .. } => self.triangles(simd, gas, blocks, &frame),
                Content::Custom { .. } => self.custom(simd, gas, &frame),
            },
            Accel::Ias(ias) => self.instances(simd, ias, &frame),
        }
    }
}

impl<'a, P: Programs> Level<'_, 'a, P> {
    #[inline(always)]
    fn triangles<S: Simd>(self, simd: S, gas: &'a Gas, blocks: &[Block], frame: &Frame) {
        let Self { here, state, path, programs, .. } = self;
        let limit = frame.depth_max(state.tmax);
        walk(simd, &gas.bvh, &frame.boxes, limit, |payload, limit| {
            let (block, used) = block_of(payload);
            let block = &blocks[block];
            let mut lanes = simd.triangles(block, &frame.shear) & used;
            let before = state.tmax;
            while lanes != 0 {
                let lane = lanes.trailing_zeros() as usize;
                lanes &= lanes - 1;
                let Some(hit) = triangle::hit(&frame.shear, block.triangle(lane)) else { continue };
                let primitive = block.primitives[lane & 7];
                if state.admits(hit.t, path, primitive) {
                    offer(hit, primitive, gas, &here, state, path, programs);
                    if state.ended {
                        return f32::NEG_INFINITY;
                    }
                }
            }
            if state.tmax < before { frame.depth_max(state.tmax) } else { limit }
        });
    }

    #[inline(always)]
    fn custom<S: Simd>(self, simd: S, gas: &'a Gas, frame: &Frame) {
        let Self { here, state, path, programs, .. } = self;
        let limit = frame.depth_max(state.tmax);
        let query = state.query;
        walk(simd, &gas.bvh, &frame.boxes, limit, |primitive, limit| {
            let record = gas.record_of(primitive);
            let verdict = any_hit_verdict(gas.flags_of(record), here.flags, query.flags);
            if verdict == Verdict::Cull {
                return limit;
            }
            let before = state.tmax;
            let site = site(primitive, record, gas, &here, &query, path);
            let mut reporter = Reporter {
                state: &mut *state,
                site: &site,
                path,
                gas,
                primitive,
                instance_offset: here.sbt_offset,
                verdict,
            };
            programs.intersect(&site, &mut reporter);
            match state.ended {
                true => f32::NEG_INFINITY,
                false if state.tmax < before => frame.depth_max(state.tmax),
                false => limit,
            }
        });
    }

    #[inline(always)]
    fn instances<S: Simd>(self, simd: S, ias: &'a Ias, frame: &Frame) {
        let Self { here, state, path, programs, .. } = self;
        let limit = frame.depth_max(state.tmax);
        walk(simd, &ias.bvh, &frame.boxes, limit, |index, limit| {
            let placed = &ias.placed[index as usize];
            if placed.instance.visibility_mask & state.query.mask == 0 {
                return limit;
            }
            let before = state.tmax;
            let exact = [placed.inverse.point(here.exact[0]), placed.inverse.vector(here.exact[1])];
            let [origin, direction] = exact.map(|v| v.map(|x| x as f32));
            path.push(index);
            simd.run(Level {
                accel: &placed.instance.child,
                here: Place {
                    ray: Ray { origin, direction },
                    exact,
                    flags: placed.instance.flags,
                    sbt_offset: here.sbt_offset + placed.instance.sbt_offset,
                },
                state: &mut *state,
                path: &mut *path,
                programs: &mut *programs,
            });
            path.pop();
            match state.ended {
                true => f32::NEG_INFINITY,
                false if state.tmax < before => frame.depth_max(state.tmax),
                false => limit,
            }
        });
    }
}

/// Culls a triangle hit that the interval admits, or asks any-hit about it, or accepts it.
#[inline]
fn offer<'a, P: Programs>(
    hit: TriangleHit,
    primitive: u32,
    gas: &'a Gas,
    here: &Place,
    state: &mut State<'a>,
    path: &InstancePath<'a>,
    programs: &mut P,
) {
    let record = gas.record_of(primitive);
    let geometry = gas.flags_of(record);
    let verdict = any_hit_verdict(geometry, here.flags, state.query.flags);
    let front = hit.front != here.flags.contains(InstanceFlags::FLIP_TRIANGLE_FACING);
    if verdict == Verdict::Cull || face_culled(geometry, here.flags, state.query.flags, front) {
        return;
    }
    let found = Found {
        t: hit.t,
        hit_kind: if front { FRONT_FACE } else { BACK_FACE },
        attributes: [hit.u.to_bits(), hit.v.to_bits(), 0, 0, 0, 0, 0, 0],
        primitive,
        record,
        instance_offset: here.sbt_offset,
        gas,
    };
    let answer = if verdict == Verdict::AnyHit {
        programs.any_hit(&Candidate {
            site: site(primitive, record, gas, here, &state.query, path),
            t: found.t,
            hit_kind: found.hit_kind,
            attributes: found.attributes,
        })
    } else {
        AnyHit::Accept
    };
    state.settle(answer, found, path);
}

fn site<'s>(
    primitive: u32,
    record: u32,
    gas: &'s Gas,
    here: &Place,
    query: &'s RayQuery,
    path: &'s InstancePath<'s>,
) -> Site<'s> {
    Site {
        primitive_index: gas.primitive_index(primitive),
        sbt_gas_index: record,
        sbt_index: sbt_index(query, here.sbt_offset, record),
        gas,
        path,
        query,
        object_ray: here.ray,
    }
}

/// A child and where the ray enters it, in one number that sorts by depth; depths are not negative, so their bits sort
/// as they do.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Entry(u64);

impl Entry {
    #[inline(always)]
    fn new(depth: f32, child: Child) -> Self {
        Self(u64::from(depth.to_bits()) << 32 | u64::from(child.0))
    }

    #[inline(always)]
    fn depth(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    #[inline(always)]
    fn child(self) -> Child {
        Child(self.0 as u32)
    }
}

/// Visits, nearest first, the leaves whose boxes the ray meets at a depth of at most `limit`. `visit` gets a leaf's
/// payload and the limit, and gives the new limit; negative infinity ends the walk.
#[inline(always)]
fn walk<S: Simd>(simd: S, bvh: &Bvh, ray: &BoxRay, mut limit: f32, mut visit: impl FnMut(u32, f32) -> f32) {
    let mut stack = [Entry(0); STACK];
    let mut top = 0;
    let mut at = Child::node(0);
    let mut near = Lanes::splat(0.0);
    loop {
        if at.is_leaf() {
            limit = visit(at.payload(), limit);
            if limit == f32::NEG_INFINITY {
                return;
            }
        } else {
            let node = &bvh.nodes[at.index()];
            let mut met = simd.boxes(node, ray, limit, &mut near);
            if met != 0 {
                let entry = |met: u32| {
                    let lane = met.trailing_zeros() as usize & 7;
                    Entry::new(near.0[lane], node.child[lane])
                };
                // The nearest child is next; the others wait on the stack, the farthest lowest.
                let mut nearest = entry(met);
                met &= met - 1;
                let base = top;
                while met != 0 {
                    let other = entry(met);
                    met &= met - 1;
                    let farther = nearest.max(other);
                    nearest = nearest.min(other);
                    let mut place = top;
                    while place > base && stack[place - 1] < farther {
                        stack[place] = stack[place - 1];
                        place -= 1;
                    }
                    stack[place] = farther;
                    top += 1;
                }
                at = nearest.child();
                continue;
            }
        }
        loop {
            if top == 0 {
                return;
            }
            top -= 1;
            if stack[top].depth() <= limit {
                at = stack[top].child();
                break;
            }
        }
    }
}
