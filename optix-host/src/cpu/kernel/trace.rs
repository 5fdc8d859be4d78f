//! Traversal.

use super::bvh::{Bvh, Child, Lanes, WIDTH};
use super::candidate::{Offer, Place, Sink};
use super::flags::Verdict;
use super::gas::{Content, block_of};
use super::ias::{Accel, Ias};
use super::path::InstancePath;
use super::program::{Hit, Programs, Reporter};
use super::ray::{BoxRay, Frame, Ray, RayQuery, SHRINK, ShearRay};
#[cfg(target_arch = "x86_64")]
use super::simd::Avx2;
use super::simd::{Portable, Simd, Task};
use super::stack::{Entry, Stack};
use super::state::State;
use super::triangle::{self, Block, Sheared, TriangleHit};
use crate::scene::InstanceFlags;

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
    simd.run(AtRoot { accel, query: ray, programs })
}

/// A trace, from preparing the ray to the hit.
struct AtRoot<'t, 'a> {
    accel: &'a Accel,
    query: &'t RayQuery,
    programs: &'t mut dyn Programs,
}

impl<'a> Task for AtRoot<'_, 'a> {
    type Output = Option<Hit<'a>>;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Option<Hit<'a>> {
        let Self { accel, query, programs } = self;
        let tmin = query.tmin.max(0.0);
        let ray = Ray { origin: query.origin, direction: query.direction };
        let exact = [widen(query.origin), widen(query.direction)];
        let frame = Frame::new(&query.origin, &query.direction, tmin)?;
        let space = Space { ray, exact, frame };
        let (state, path) = (&mut State::new(query, tmin, accel), &mut InstancePath::new(accel));
        let place = Place { query, tmin, space: &space, flags: InstanceFlags::NONE, sbt_offset: 0 };
        match accel {
            Accel::Gas(gas) => {
                let sink = Sink { gas, place, path, state: &mut *state };
                simd.run(AtGas { sink, programs, far: false });
            }
            Accel::Ias(ias) => AtIas { ias, place, state, path, programs }.run(simd),
        }
        state.hit(query)
    }
}

/// The ray in some space.
pub struct Space {
    pub ray: Ray,
    /// Origin and direction before rounding.
    exact: [[f64; 3]; 2],
    frame: Frame,
}

impl Space {
    /// The rounded ray if it misses everything.
    #[inline(always)]
    fn new(exact: [[f64; 3]; 2], tmin: f32) -> Result<Self, Ray> {
        let ray = Ray { origin: narrow(exact[0]), direction: narrow(exact[1]) };
        Ok(Self { ray, exact, frame: Frame::new(&ray.origin, &ray.direction, tmin).ok_or(ray)? })
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
struct AtGas<'t, 'a> {
    sink: Sink<'t, 'a>,
    programs: &'t mut dyn Programs,
    /// Whether differences of coordinates may overflow.
    far: bool,
}

impl Task for AtGas<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(mut self, simd: S) {
        let (gas, frame) = (self.sink.gas, &self.sink.place.space.frame);
        let limit = frame.depth_max(self.sink.state.tmax);
        match &gas.content {
            Content::Triangles { blocks, .. } if gas.bvh.nodes.is_empty() => {
                if let Some(far) = frame.is_far(&gas.bvh.bounds) {
                    self.far = far;
                    self.few(simd, blocks, limit);
                }
            }
            Content::Triangles { blocks, .. } => {
                let Some(boxes) = frame.boxes(&gas.bvh.bounds, 1.0) else { return };
                self.far = boxes.far;
                walk(simd, &gas.bvh, &boxes, limit, |payload, limit| {
                    let (index, used) = block_of(payload);
                    self.block(simd, &blocks[index], index, used, limit)
                });
            }
            Content::Custom { .. } => {
                let Some(boxes) = frame.boxes(&gas.bvh.bounds, 1.0) else { return };
                walk(simd, &gas.bvh, &boxes, limit, |primitive, limit| self.custom(primitive, limit));
            }
        }
    }
}

impl AtGas<'_, '_> {
    /// Tests all triangles of a structure without nodes.
    #[inline(always)]
    fn few<S: Simd>(&mut self, simd: S, blocks: &[Block], mut limit: f32) {
        let mut left = self.sink.gas.primitive_count();
        for (index, block) in blocks.iter().enumerate() {
            let used = (1 << left.min(WIDTH)) - 1;
            left -= left.min(WIDTH);
            limit = self.block(simd, block, index, used, limit);
            if limit == f32::NEG_INFINITY {
                return;
            }
        }
    }

    /// Tests the triangles of a block that `used` has a bit for. Gives the new limit of depth, as [`walk`] wants it.
    #[inline(always)]
    fn block<S: Simd>(&mut self, simd: S, block: &Block, index: usize, used: u32, limit: f32) -> f32 {
        let frame = &self.sink.place.space.frame;
        if self.far {
            return self.far_block(simd, block, index, used, limit);
        }
        let mut sheared = Sheared::default();
        let met = simd.triangles(block, &frame.shear, [frame.depth_min, limit], &mut sheared);
        let before = self.sink.state.tmax;
        self.meet(&frame.shear, met & used, &sheared, block, index);
        self.sink.state.limit(before, limit, frame)
    }

    /// [`AtGas::block`] where coordinates are so large that it is done with smaller ones.
    #[cold]
    #[inline(never)]
    fn far_block<S: Simd>(&mut self, simd: S, block: &Block, index: usize, used: u32, limit: f32) -> f32 {
        let frame = &self.sink.place.space.frame;
        let shear = frame.shear.shrunk();
        let mut sheared = Sheared::default();
        let depths = [frame.depth_min * SHRINK, limit * SHRINK];
        let met = simd.triangles(&block.shrunk(), &shear, depths, &mut sheared);
        let before = self.sink.state.tmax;
        self.meet(&shear, met & used, &sheared, block, index);
        self.sink.state.limit(before, limit, frame)
    }

    /// Decides about the triangles of a block in these lanes.
    #[inline(always)]
    fn meet(&mut self, shear: &ShearRay, mut lanes: u32, sheared: &Sheared, block: &Block, index: usize) {
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize & (WIDTH - 1);
            lanes &= lanes - 1;
            let Some(hit) = triangle::hit(shear, triangle::lane_of(sheared, lane)) else { continue };
            let primitive = block.primitives[lane];
            if self.sink.admits(hit.t, primitive) {
                self.offer(hit, primitive, (index * WIDTH + lane) as u32);
                if self.sink.state.ended {
                    return;
                }
            }
        }
    }

    /// Offers a hit that the interval admits, unless flags hide the triangle.
    #[inline]
    fn offer(&mut self, hit: TriangleHit, primitive: u32, slot: u32) {
        let record = self.sink.gas.record_of(primitive);
        let verdict = self.sink.verdict(record);
        if verdict == Verdict::Cull {
            return;
        }
        let Some(front) = self.sink.facing(record, hit.front) else { return };
        let offer = Offer {
            t: hit.t,
            hit_kind: if front { FRONT_FACE } else { BACK_FACE },
            attributes: [hit.u.to_bits(), hit.v.to_bits(), 0, 0, 0, 0, 0, 0],
            primitive,
            record,
            slot,
        };
        self.sink.take(offer, verdict, self.programs);
    }

    /// Has the intersection program look at a primitive. Gives the new limit of depth.
    #[inline(always)]
    fn custom(&mut self, primitive: u32, limit: f32) -> f32 {
        let Sink { gas, place, path, ref mut state } = self.sink;
        let record = gas.record_of(primitive);
        let sink = Sink { gas, place, path, state };
        let verdict = sink.verdict(record);
        if verdict == Verdict::Cull {
            return limit;
        }
        let before = sink.state.tmax;
        let site = place.site(gas, path, primitive, record);
        self.programs.intersect(&site, &mut Reporter { sink, primitive, record, verdict });
        self.sink.state.limit(before, limit, &place.space.frame)
    }
}

/// Traversal of an instance acceleration structure.
struct AtIas<'t, 'a> {
    ias: &'a Ias,
    place: Place<'t>,
    state: &'t mut State<'a>,
    path: &'t mut InstancePath<'a>,
    programs: &'t mut dyn Programs,
}

impl Task for AtIas<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { ias, place: here, state, path, programs } = self;
        let frame = &here.space.frame;
        let Some(boxes) = frame.boxes(&ias.bvh.bounds, ias.slack) else { return };
        let limit = frame.depth_max(state.tmax);
        walk(simd, &ias.bvh, &boxes, limit, |index, limit| {
            let placed = &ias.placed[index as usize];
            let instance = &placed.instance;
            if instance.visibility_mask & here.query.mask == 0 {
                return limit;
            }
            let own;
            let space = if placed.identity {
                here.space
            } else {
                let [origin, direction] = here.space.exact;
                let exact = [placed.inverse.point(origin), placed.inverse.vector(direction)];
                match Space::new(exact, here.tmin) {
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
            let place =
                Place { space, flags: instance.flags, sbt_offset: here.sbt_offset + instance.sbt_offset, ..here };
            let before = state.tmax;
            path.push(index);
            match &*instance.child {
                Accel::Gas(gas) => {
                    let sink = Sink { gas, place, path, state: &mut *state };
                    simd.run(AtGas { sink, programs: &mut *programs, far: false });
                }
                Accel::Ias(ias) => {
                    simd.run(AtIas { ias, place, state: &mut *state, path: &mut *path, programs: &mut *programs });
                }
            }
            path.pop();
            state.limit(before, limit, frame)
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
