//! Traversal.

use super::bvh::{Bvh, Child, Lanes};
use super::candidate::{HitSink, InstanceContext};
use super::ias::{Accel, Ias};
use super::path::InstancePath;
use super::primitive::{LeafRay, Leaves, Primitives};
use super::program::{Hit, Programs};
use super::ray::{BoxRay, PreparedRay, Ray, RayQuery};
#[cfg(target_arch = "x86_64")]
use super::simd::Avx2;
use super::simd::{Portable, Simd, Task};
use super::stack::{Entry, Stack};
use super::state::TraceState;
use crate::scene::InstanceFlags;

/// Traces a ray (guide 13.2) and gives its closest accepted hit. No structure at all is a miss.
///
/// The interval `[tmin, tmax]` is closed. Hits at the same `t` are ordered by instance path (index by index from the
/// root) and then by primitive (counted over the build inputs of the GAS): the first wins, so the result does not
/// depend on the order of traversal, on the instruction set or on threads. A candidate that ties with the closest hit
/// but comes after it is dropped without an any-hit call; one that comes before it is offered to any-hit like any other.
/// A custom primitive's second report at the same `t` comes after its first.
///
/// Which candidates behind the final hit are offered to any-hit depends on the order of traversal, as the guide allows
/// (guide 13.4); that order is the same in every run.
///
/// Watertight within a GAS: see `primitive/triangle/intersect.rs`. Between instances nothing is promised, as in OptiX, because each has a
/// ray of its own.
///
/// It is compiled once, here, and calls the programs through a table, so that it is as fast from other crates as it is from this
/// one, with link-time optimisation or without.
#[inline(never)]
pub fn trace<'a>(accel: Option<&'a Accel>, ray: &RayQuery, programs: &mut dyn Programs) -> Option<Hit<'a>> {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = Avx2::detect() {
        return trace_with(simd, accel, ray, programs);
    }
    trace_with(Portable, accel, ray, programs)
}

/// [`trace`] as it is on a machine without AVX2, to compare the two: hits are the same, bit for bit.
#[inline(never)]
pub fn trace_portable<'a>(accel: Option<&'a Accel>, ray: &RayQuery, programs: &mut dyn Programs) -> Option<Hit<'a>> {
    trace_with(Portable, accel, ray, programs)
}

#[inline(always)]
fn trace_with<'a, S: Simd>(
    simd: S,
    accel: Option<&'a Accel>,
    ray: &RayQuery,
    programs: &mut dyn Programs,
) -> Option<Hit<'a>> {
    let accel = accel?;
    if ray.tmin.is_nan() || ray.tmax.is_nan() || ray.tmin.max(0.0) > ray.tmax {
        return None;
    }
    simd.run(RootTraversal { accel, query: ray, programs })
}

/// A trace, from preparing the ray to the hit.
struct RootTraversal<'t, 'a> {
    accel: &'a Accel,
    query: &'t RayQuery,
    programs: &'t mut dyn Programs,
}

impl<'a> Task for RootTraversal<'_, 'a> {
    type Output = Option<Hit<'a>>;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Option<Hit<'a>> {
        let Self { accel, query, programs } = self;
        let tmin = query.tmin.max(0.0);
        let ray = Ray { origin: query.origin, direction: query.direction };
        let exact = [widen(query.origin), widen(query.direction)];
        let prepared = PreparedRay::new(&query.origin, &query.direction, tmin)?;
        let space = Space { ray, exact, prepared };
        let (state, path) = (&mut TraceState::new(query, tmin, accel), &mut InstancePath::new(accel));
        let context = InstanceContext { query, tmin, space: &space, flags: InstanceFlags::NONE, sbt_offset: 0 };
        match accel {
            Accel::Gas(gas) => {
                let sink = HitSink { gas, context, path, state: &mut *state };
                simd.run(LeafRay { sink, programs, far: false });
            }
            Accel::Ias(ias) => IasTraversal { ias, context, state, path, programs }.run(simd),
        }
        state.hit(query)
    }
}

/// The ray in some space.
pub struct Space {
    pub ray: Ray,
    /// Origin and direction before rounding.
    exact: [[f64; 3]; 2],
    pub prepared: PreparedRay,
}

impl Space {
    /// The rounded ray if it misses everything.
    #[inline(always)]
    fn new(exact: [[f64; 3]; 2], tmin: f32) -> Result<Self, Ray> {
        let ray = Ray { origin: narrow(exact[0]), direction: narrow(exact[1]) };
        Ok(Self { ray, exact, prepared: PreparedRay::new(&ray.origin, &ray.direction, tmin).ok_or(ray)? })
    }
}

// `array::map` is not inlined into functions that are compiled for another instruction set than it is.
#[inline(always)]
fn widen([x, y, z]: [f32; 3]) -> [f64; 3] {
    [x.into(), y.into(), z.into()]
}

#[inline(always)]
fn narrow([x, y, z]: [f64; 3]) -> [f32; 3] {
    [x as f32, y as f32, z as f32]
}

/// Traversal of a geometry acceleration structure.
impl Task for LeafRay<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        match &self.sink.gas.primitives {
            Primitives::Triangles(triangles) => self.traverse(simd, triangles),
            Primitives::Custom(custom) => self.traverse(simd, custom),
        }
    }
}

impl LeafRay<'_, '_> {
    #[inline(always)]
    fn traverse<S: Simd>(mut self, simd: S, leaves: &impl Leaves) {
        let (bvh, prepared) = (&self.sink.gas.bvh, &self.sink.context.space.prepared);
        let limit = prepared.depth_max(self.sink.state.tmax);
        if bvh.nodes.is_empty() {
            if let Some(far) = prepared.is_far(&bvh.bounds) {
                self.far = far;
                leaves.visit_all(simd, &mut self, limit);
            }
        } else if let Some(boxes) = prepared.boxes(&bvh.bounds, 1.0) {
            self.far = boxes.far;
            walk(simd, bvh, &boxes, limit, |leaf, limit| leaves.visit(simd, &mut self, leaf, limit));
        }
    }
}

/// Traversal of an instance acceleration structure.
struct IasTraversal<'t, 'a> {
    ias: &'a Ias,
    context: InstanceContext<'t>,
    state: &'t mut TraceState<'a>,
    path: &'t mut InstancePath<'a>,
    programs: &'t mut dyn Programs,
}

impl Task for IasTraversal<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { ias, context: parent, state, path, programs } = self;
        let prepared = &parent.space.prepared;
        let Some(boxes) = prepared.boxes(&ias.bvh.bounds, ias.slack) else { return };
        let limit = prepared.depth_max(state.tmax);
        walk(simd, &ias.bvh, &boxes, limit, |index, limit| {
            let built = &ias.built[index as usize];
            let instance = &built.instance;
            if instance.visibility_mask & parent.query.mask == 0 {
                return limit;
            }
            let own;
            let space = if built.identity {
                parent.space
            } else {
                let [origin, direction] = parent.space.exact;
                let exact = [built.inverse.point(origin), built.inverse.vector(direction)];
                match Space::new(exact, parent.tmin) {
                    Ok(space) => own = space,
                    Err(ray) => {
                        path.push(index);
                        programs.no_ray(path, &ray);
                        path.pop();
                        return limit;
                    }
                }
                &own
            };
            let context = InstanceContext {
                space,
                flags: instance.flags,
                sbt_offset: parent.sbt_offset + instance.sbt_offset,
                ..parent
            };
            let before = state.tmax;
            path.push(index);
            match &*instance.child {
                Accel::Gas(gas) => {
                    let sink = HitSink { gas, context, path, state: &mut *state };
                    simd.run(LeafRay { sink, programs: &mut *programs, far: false });
                }
                Accel::Ias(ias) => {
                    simd.run(IasTraversal {
                        ias,
                        context,
                        state: &mut *state,
                        path: &mut *path,
                        programs: &mut *programs,
                    });
                }
            }
            path.pop();
            state.limit(before, limit, prepared)
        });
    }
}

/// Visits, nearest first, the leaves whose boxes the ray meets at a depth of at most `limit`. `visit` gets a leaf's
/// payload and the limit, and gives the new limit; negative infinity ends the walk.
#[inline(always)]
fn walk<S: Simd>(simd: S, bvh: &Bvh, ray: &BoxRay, mut limit: f32, mut visit: impl FnMut(u32, f32) -> f32) {
    let mut stack = Stack::new();
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
                // The nearest child is next; the others wait on the stack. Up to four are sorted without branches.
                let mut nearest = entry(met);
                met &= met - 1;
                if met.count_ones() <= 3 {
                    if met != 0 {
                        let sort = |a: &mut Entry, b: &mut Entry| (*a, *b) = ((*a).min(*b), (*a).max(*b));
                        let mut second = entry(met);
                        met &= met - 1;
                        sort(&mut nearest, &mut second);
                        if met != 0 {
                            let mut third = entry(met);
                            met &= met - 1;
                            sort(&mut nearest, &mut third);
                            sort(&mut second, &mut third);
                            if met != 0 {
                                let mut fourth = entry(met);
                                sort(&mut nearest, &mut fourth);
                                sort(&mut second, &mut fourth);
                                sort(&mut third, &mut fourth);
                                stack.push(fourth);
                            }
                            stack.push(third);
                        }
                        stack.push(second);
                    }
                } else {
                    let base = stack.len();
                    while met != 0 {
                        let other = entry(met);
                        met &= met - 1;
                        stack.insert(nearest.max(other), base);
                        nearest = nearest.min(other);
                    }
                }
                at = nearest.child();
                continue;
            }
        }
        at = loop {
            match stack.pop() {
                None => return,
                Some(next) if next.depth() <= limit => break next.child(),
                Some(_) => {}
            }
        };
    }
}
