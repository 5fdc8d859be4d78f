//! Rays that leave surfaces, and whether they meet again what they left: for the bound of `SurfacePoint`.

use optix_device_rs::prelude::*;
use optix_device_rs::surface::gamma;
use path_tracer_shaders::ball::{self, Ball, BallHit};

/// A ray to a primitive, from whose hit others leave.
#[derive(Clone, Copy, Debug, PartialEq, Element)]
#[repr(C)]
pub struct Start {
    /// Origin in world space.
    pub origin: [f32; 3],
    /// The primitive that it is to meet; others don't count.
    pub primitive: u32,
    /// Direction in world space.
    pub direction: [f32; 3],
    /// Of random directions.
    pub seed: u32,
    /// Direction of the ray that leaves, for [`margin`]; the side of [`neighbour`]'s rays.
    pub leaving: [f32; 3],
    /// A primitive that the rays of [`neighbour`] must meet, and that those of [`between`] must see.
    pub other: u32,
}

/// What became of the rays that left from one hit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Element)]
#[repr(C)]
pub struct Departure {
    /// Rays that left.
    pub traced: u32,
    /// Those that met what they left, or, of [`between`], an end.
    pub own: u32,
    /// Those that did not meet what they had to.
    pub lost: u32,
    /// The error bound.
    pub error: f32,
    /// Direction of the last ray that met what it left.
    pub direction: [f32; 3],
    /// Of [`margin`]: the largest offset, in units of the bound, at which a ray meets what it left; 0 if there is none,
    /// -1 if the first ray missed.
    pub margin: f32,
}

/// The launch parameters.
#[launch_params]
pub struct SpawnFrame {
    /// One for each launch index; for [`between`] two.
    pub starts: Slice<Start>,
    /// What became of them.
    pub departures: SliceMut<Departure>,
    /// The scene.
    pub world: Traversable,
    /// Rays that leave from each hit.
    pub rays: u32,
    /// Where the rays of `starts` end; what they are to meet is at `t` = 1.
    pub reach: f32,
    /// Whether points have the bound of version 0.1, which took a triangle's error per axis: to see that tests can fail.
    pub per_axis: bool,
}

/// The hit on one primitive.
#[derive(Payload)]
pub struct Met {
    /// The primitive that counts.
    #[payload(write(caller), read(anyhit))]
    pub only: u32,
    /// Whether there is a hit.
    #[payload(write(caller, closesthit), read(caller))]
    pub met: bool,
    /// Hit kind.
    #[payload(write(closesthit, miss), read(caller))]
    pub kind: u32,
    /// Position of the surface point.
    #[payload(write(closesthit, miss), read(caller))]
    pub position: Vec3,
    /// Its normal.
    #[payload(write(closesthit, miss), read(caller))]
    pub normal: Vec3,
    /// Its error.
    #[payload(write(closesthit, miss), read(caller))]
    pub error: f32,
    /// Its error for rays from afar.
    #[payload(write(closesthit, miss), read(caller))]
    pub error_per_length: f32,
}

/// No primitive.
pub const NONE: u32 = !0;

/// A surface of triangles.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Sheet {}

/// A box around the origin of object space.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Slab {
    /// Half its size.
    pub half: Vec3,
}

/// A hit on a [`Slab`].
#[derive(Clone, Copy, Debug, Attributes)]
pub struct SlabHit {
    /// The point in object space; on its face exactly.
    pub at: Vec3,
}

fn met(rg: &RayGen<Spawn>, ray: Ray, only: u32) -> MetAtCaller {
    rg.trace::<Met>(rg.params().world(), ray, MetFromCaller { only, met: false })
}

/// The surface point that a start names.
fn point_of(rg: &RayGen<Spawn>, start: &Start) -> (MetAtCaller, SurfacePoint) {
    let ray = Ray::new(Vec3::from_array(start.origin), Vec3::from_array(start.direction));
    let first = met(rg, ray.range(0.0, rg.params().reach()), start.primitive);
    let mut point = SurfacePoint::new(first.position, first.normal, first.error);
    point.error_per_length = first.error_per_length;
    (first, point)
}

/// A direction of any kind: into all of the sphere, grazing, nearly or exactly along an axis, in the plane as far as that can be.
fn leaving(rng: &mut Pcg32, normal: Vec3) -> Vec3 {
    let kind = rng.next_u32();
    let any = crate::sphere(rng.next_vec2());
    let tangent = normal.cross(any);
    // From 1 to 2^-30.
    let small = f32::from_bits((127 - rng.next_u32() % 31) << 23) * (rng.next_f32() - 0.5);
    let axis = |k: u32| Vec3::new((k == 0) as u32 as f32, (k == 1) as u32 as f32, (k == 2) as u32 as f32);
    let direction = match kind % 4 {
        0 => any,
        1 => tangent + normal * small,
        2 => axis(rng.next_u32() % 3) + any * small,
        _ => tangent,
    };
    // Any length.
    direction * f32::from_bits((107 + kind / 4 % 41) << 23)
}

/// The ray that leaves in a direction. Into a ball or a box a ray meets it again, rightly, so from these it leaves on the outside; a
/// grazing direction may be on either side as rounding has it.
fn outward(point: &SurfacePoint, kind: u32, direction: Vec3) -> Ray {
    if kind >= 128 {
        return point.ray(direction);
    }
    let direction = if direction.dot(point.normal) < 0.0 { -direction } else { direction };
    Ray::new(point.position + point.normal * point.error, direction)
}

/// Sends rays from a hit to both sides in all directions; counts those that meet the primitive again.
#[raygen]
pub fn leave(rg: &RayGen<Spawn>) {
    let frame = rg.params();
    let index = rg.launch_index().x;
    let start = frame.starts().get(index);
    let (first, point) = point_of(rg, &start);
    let mut departure = Departure { error: point.error, ..NOTHING };
    if first.met {
        let mut rng = Pcg32::hashed(start.seed as u64, 2);
        let mut i = 0;
        while i < frame.rays() {
            let ray = outward(&point, first.kind, leaving(&mut rng, point.normal));
            departure.traced += 1;
            if met(rg, ray, start.primitive).met {
                departure.own += 1;
                departure.direction = ray.direction.to_array();
            }
            i += 1;
        }
    }
    frame.departures().set(index, departure);
}

/// Finds the largest offset at which a ray meets the primitive again: of the ray in the given direction where `rays` is 0, and
/// else of so many in all directions.
#[raygen]
pub fn margin(rg: &RayGen<Spawn>) {
    let frame = rg.params();
    let index = rg.launch_index().x;
    let start = frame.starts().get(index);
    let (first, point) = point_of(rg, &start);
    let mut departure = Departure { error: point.error, margin: -1.0, ..NOTHING };
    if first.met {
        let mut rng = Pcg32::hashed(start.seed as u64, 4);
        departure.margin = 0.0;
        let mut left = frame.rays().max(1);
        while left > 0 {
            let direction = match frame.rays() {
                0 => Vec3::from_array(start.leaving),
                _ => leaving(&mut rng, point.normal),
            };
            let fails = |share: f32| {
                let nearer = SurfacePoint { error: point.error * share, ..point };
                met(rg, outward(&nearer, first.kind, direction), start.primitive).met
            };
            // Whether a ray is seen to meet the surface is not monotonous in the offset: from above, in steps of 2^-1/4,
            // and then between the last two.
            let (mut works, mut share, least) = (4.0, 2.0, departure.margin.max(1e-4));
            while share > least && !fails(share) {
                (works, share) = (share, share * 0.840_896_4);
            }
            if share > least {
                let mut i = 0;
                while i < 5 {
                    let middle = 0.5 * (works + share);
                    if fails(middle) {
                        share = middle
                    } else {
                        works = middle
                    }
                    i += 1;
                }
                departure.margin = share;
                departure.direction = direction.to_array();
            }
            departure.traced += 1;
            left -= 1;
        }
    }
    frame.departures().set(index, departure);
}

/// Sends rays from a hit towards a surface that is a little farther than both errors, on the side of the given
/// direction: they must meet that one, and not what they left.
#[raygen]
pub fn neighbour(rg: &RayGen<Spawn>) {
    let frame = rg.params();
    let index = rg.launch_index().x;
    let start = frame.starts().get(index);
    let (first, point) = point_of(rg, &start);
    let mut departure = Departure { error: point.error, ..NOTHING };
    if first.met {
        let mut rng = Pcg32::hashed(start.seed as u64, 3);
        let mut i = 0;
        while i < frame.rays() {
            let any = crate::sphere(rng.next_vec2());
            let up = Vec3::from_array(start.leaving);
            // Within 60 degrees.
            let direction = up + any * 0.8;
            let ray = point.ray(direction);
            departure.traced += 1;
            if met(rg, ray, start.primitive).met {
                departure.own += 1;
                departure.direction = direction.to_array();
            }
            departure.lost += !met(rg, ray, start.other).met as u32;
            i += 1;
        }
    }
    frame.departures().set(index, departure);
}

/// Sends a segment between two points, both ways: it must meet neither end, and whatever is between. Counts pairs where a
/// point is in the other one's plane, as far as errors go, as not traced.
#[raygen]
pub fn between(rg: &RayGen<Spawn>) {
    let frame = rg.params();
    let index = rg.launch_index().x;
    let (from, to) = (frame.starts().get(2 * index), frame.starts().get(2 * index + 1));
    let ((first, a), (second, b)) = (point_of(rg, &from), point_of(rg, &to));
    let mut departure = Departure { error: a.error, ..NOTHING };
    if first.met && second.met {
        let way = b.position - a.position;
        let both = a.error + b.error + (a.error_per_length + b.error_per_length) * way.abs().max_element();
        let apart = a.normal.dot(way).abs().min(b.normal.dot(way).abs());
        if apart > 2.0 * both {
            for (ray, way) in [(a.ray_to(&b), way), (b.ray_to(&a), -way)] {
                departure.traced += 1;
                let end = met(rg, ray, from.primitive).met | met(rg, ray, to.primitive).met;
                departure.own += end as u32;
                if end {
                    departure.direction = way.to_array();
                }
                // The offsets, which may lie askew in object space, don't take the ray past what is between.
                departure.lost += (apart > 1e5 * both && !met(rg, ray, from.other).met) as u32;
            }
        }
    }
    frame.departures().set(index, departure);
}

const NOTHING: Departure = Departure { traced: 0, own: 0, lost: 0, error: 0.0, direction: [0.0; 3], margin: 0.0 };

/// The surface point of a triangle hit as version 0.1 had it.
fn per_axis(hit: &ClosestHit<Spawn, Triangles>) -> SurfacePoint {
    let ([p0, p1, p2], at) = (hit.vertices(), hit.barycentrics());
    let (to_world, to_object) = (hit.object_to_world(), hit.world_to_object());
    let (e1, e2) = (p1 - p0, p2 - p0);
    let (t0, t1, t2) = (p0 * (1.0 - at.x - at.y), p1 * at.x, p2 * at.y);
    let (point, normal) = (t0 + t1 + t2, e1.cross(e2).normalize());
    let interpolation = (t0.abs() + t1.abs() + t2.abs()) * gamma(5) + p0.abs() * (2.0 / 16_777_216.0);
    let error = interpolation + (e1.abs() + e2.abs()) * gamma(16);
    let position = to_world.point(point);
    let residual = normal.dot(to_object.point(position) - point).abs();
    let row = |[x, y, z, w]: [f32; 4]| Vec3::new(x, y, z).abs().dot(position.abs()) + w.abs();
    let mapping = Vec3::from_array(to_object.rows().map(row)) * (2.0 * gamma(4) + 2.0 / 16_777_216.0);
    let world_normal = to_object.normal(normal);
    let per_length = world_normal.length().recip();
    let error = ((error + mapping).dot(normal.abs()) + residual) * per_length * (1.0 + gamma(16));
    SurfacePoint::new(position, world_normal * per_length, error)
}

#[closesthit]
fn sheet(hit: &ClosestHit<Spawn, Triangles>) -> MetFromClosestHit {
    let point = if hit.params().per_axis() { per_axis(hit) } else { hit.surface_point() };
    at(hit, point)
}

#[closesthit]
fn round(hit: &ClosestHit<Spawn, BallHit>, record: &Ball) -> MetFromClosestHit {
    at(hit, record.surface_point(hit.attributes().normal, &hit.object_to_world(), &hit.world_to_object()))
}

/// Intersects the box, by slabs.
#[intersection]
fn slab(isect: &Intersection<Spawn, SlabHit>, record: &Slab) {
    let (o, d) = (isect.object_ray_origin(), isect.object_ray_direction());
    let inverse = Vec3::ONE / d;
    let (low, high) = ((-record.half - o) * inverse, (record.half - o) * inverse);
    let (near, far) = (low.min(high).max_element(), low.max(high).min_element());
    if near <= far {
        let at = |t: f32| {
            let p = o + d * t;
            // The face is that of the coordinate which is nearest to it.
            let beyond = (p.abs() - record.half).abs();
            let least = beyond.min_element();
            let on = |p: f32, half: f32, beyond: f32| if beyond == least { half.copysign(p) } else { p };
            let half = record.half;
            SlabHit { at: Vec3::new(on(p.x, half.x, beyond.x), on(p.y, half.y, beyond.y), on(p.z, half.z, beyond.z)) }
        };
        if !isect.report(near, 0, at(near)) {
            isect.report(far, 1, at(far));
        }
    }
}

#[closesthit]
fn flat(hit: &ClosestHit<Spawn, SlabHit>, record: &Slab) -> MetFromClosestHit {
    let (at_, half) = (hit.attributes().at, record.half);
    let face = |p: f32, half: f32| if p.abs() == half { 1.0f32.copysign(p) } else { 0.0 };
    let normal = Vec3::new(face(at_.x, half.x), face(at_.y, half.y), face(at_.z, half.z));
    // On an edge one of the faces.
    let normal = if normal.x != 0.0 {
        Vec3::new(normal.x, 0.0, 0.0)
    } else if normal.y != 0.0 {
        Vec3::new(0.0, normal.y, 0.0)
    } else {
        normal
    };
    let error = Vec3::splat(2.0 * half.max_element() * gamma(12));
    at(hit, SurfacePoint::of_object(at_, normal, error, &hit.object_to_world(), &hit.world_to_object()))
}

fn at<A: Attributes>(hit: &ClosestHit<Spawn, A>, point: SurfacePoint) -> MetFromClosestHit {
    MetFromClosestHit {
        met: true,
        kind: hit.hit_kind().get() as u32,
        position: point.position,
        normal: point.normal,
        error: point.error,
        error_per_length: point.error_per_length,
    }
}

fn counts(primitive: u32, only: u32) -> Decision {
    if only == primitive { Decision::Accept } else { Decision::Ignore }
}

#[anyhit]
fn sheet_counts(hit: &AnyHit<Spawn, Triangles>, ray: MetAtAnyHit) -> Decision {
    counts(hit.primitive_index(), ray.only)
}

#[anyhit]
fn ball_counts(hit: &AnyHit<Spawn, BallHit>, ray: MetAtAnyHit) -> Decision {
    counts(hit.primitive_index(), ray.only)
}

#[anyhit]
fn slab_counts(hit: &AnyHit<Spawn, SlabHit>, ray: MetAtAnyHit) -> Decision {
    counts(hit.primitive_index(), ray.only)
}

#[miss]
fn nothing(_ms: &Miss<Spawn>) -> MetFromMiss {
    MetFromMiss { kind: 0, position: Vec3::ZERO, normal: Vec3::ZERO, error: 0.0, error_per_length: 0.0 }
}

pipeline! {
    /// Rays that leave surfaces.
    pub struct Spawn {
        params: SpawnFrame,
        raygen: [leave, margin, neighbour, between],
        rays: { Met { miss: nothing } },
        hitgroups: {
            Sheet on Triangles => { Met { closesthit: sheet, anyhit: sheet_counts } },
            Ball on Custom => { Met { intersection: ball::ball, closesthit: round, anyhit: ball_counts } },
            Slab on Custom => { Met { intersection: slab, closesthit: flat, anyhit: slab_counts } },
        },
    }
}
