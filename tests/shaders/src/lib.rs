//! Device programs that report what a ray meets, for tests across backends.
#![no_std]

pub mod callables;
pub mod deep;
pub mod queries;
pub mod reports;
pub mod spawn;
pub mod textures;

use optix_device_rs::prelude::*;
use path_tracer_shaders::ball::{self, Ball, BallHit};

/// A ray to trace.
#[derive(Clone, Copy, Debug, PartialEq, Element)]
#[repr(C)]
pub struct ProbeRay {
    /// Origin in world space.
    pub origin: [f32; 3],
    /// Least `t`.
    pub tmin: f32,
    /// Direction in world space.
    pub direction: [f32; 3],
    /// Greatest `t`.
    pub tmax: f32,
}

/// What it met.
#[derive(Clone, Copy, Debug, PartialEq, Element)]
#[repr(C)]
pub struct ProbeHit {
    /// Instance id; `!0` for a miss.
    pub instance: u32,
    /// Primitive index.
    pub primitive: u32,
    /// Hit kind.
    pub kind: u32,
    /// Ray parameter.
    pub t: f32,
    /// Barycentrics.
    pub u: f32,
    /// Barycentrics.
    pub v: f32,
}

/// The launch parameters.
#[launch_params]
pub struct ProbeFrame {
    /// The rays, one per launch index.
    pub rays: Slice<ProbeRay>,
    /// What they met.
    pub hits: SliceMut<ProbeHit>,
    /// Per launch index: secondary rays that met the triangle they left, that missed, and that were traced.
    pub tallies: SliceMut<[u32; 4]>,
    /// The scene.
    pub world: Traversable,
    /// Secondary rays per hit.
    pub secondary: u32,
    /// How much of a surface point's error bound rays are moved by: 1 for all of it, 0 for none.
    pub offset: f32,
}

/// The nearest hit.
#[derive(Payload)]
pub struct Nearest {
    /// `!0` for a miss.
    #[payload(write(caller, closesthit), read(caller))]
    pub instance: u32,
    /// Primitive index.
    #[payload(write(closesthit, miss), read(caller))]
    pub primitive: u32,
    /// Hit kind.
    #[payload(write(closesthit, miss), read(caller))]
    pub kind: u32,
    /// Ray parameter.
    #[payload(write(closesthit, miss), read(caller))]
    pub t: f32,
    /// Barycentrics.
    #[payload(write(closesthit, miss), read(caller))]
    pub at: Vec2,
    /// Position, normal and error of the surface point.
    #[payload(write(closesthit, miss), read(caller))]
    pub position: Vec3,
    /// Unit normal.
    #[payload(write(closesthit, miss), read(caller))]
    pub normal: Vec3,
    /// Error bound.
    #[payload(write(closesthit, miss), read(caller))]
    pub error: f32,
}

/// A surface that is only looked at.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Surface {}

/// Traces the ray of this launch index.
#[raygen]
pub fn probe(rg: &RayGen<Probe>) {
    let frame = rg.params();
    let index = rg.launch_index().x;
    let hit = nearest(rg, ray_of(frame.rays().get(index)));
    let (u, v) = (hit.at.x, hit.at.y);
    let hit = ProbeHit { instance: hit.instance, primitive: hit.primitive, kind: hit.kind, t: hit.t, u, v };
    frame.hits().set(index, hit);
}

/// Traces the ray of this launch index and, from where it hits, secondary rays to both sides in all directions.
#[raygen]
pub fn respawn(rg: &RayGen<Probe>) {
    let frame = rg.params();
    let index = rg.launch_index().x;
    let first = nearest(rg, ray_of(frame.rays().get(index)));
    let mut tally = [0; 4];
    if first.instance != !0 {
        let error = first.error * frame.offset();
        let point = SurfacePoint::new(first.position, first.normal, error);
        let mut rng = Pcg32::hashed(index as u64, 1);
        let mut i = 0;
        while i < frame.secondary() {
            // Into a ball a ray meets it again, rightly; from a triangle it may go to both sides.
            let direction = sphere(rng.next_vec2());
            let into = first.kind < 128 && direction.dot(first.normal) < 0.0;
            let hit = nearest(rg, point.ray(if into { -direction } else { direction }));
            let own = hit.instance == first.instance && hit.primitive == first.primitive;
            tally = [tally[0] + own as u32, tally[1] + (hit.instance == !0) as u32, tally[2] + 1, 0];
            i += 1;
        }
    }
    frame.tallies().set(index, tally);
}

fn ray_of(ray: ProbeRay) -> Ray {
    Ray::new(Vec3::from_array(ray.origin), Vec3::from_array(ray.direction)).range(ray.tmin, ray.tmax)
}

fn nearest(rg: &RayGen<Probe>, ray: Ray) -> NearestAtCaller {
    rg.trace::<Nearest>(rg.params().world(), ray, NearestFromCaller { instance: !0 })
}

/// A direction, uniform over the sphere.
fn sphere(at: Vec2) -> Vec3 {
    let z = 1.0 - 2.0 * at.x;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = optix_device_rs::math::sin_cos_turns(at.y);
    Vec3::new(r * cos, r * sin, z)
}

/// Reports a hit on a triangle.
#[closesthit]
fn found(hit: &ClosestHit<Probe, Triangles>) -> NearestFromClosestHit {
    found_at(hit, hit.barycentrics(), hit.surface_point())
}

/// Reports a hit on a ball, whose intersection program is the path tracer's.
#[closesthit]
fn found_ball(hit: &ClosestHit<Probe, BallHit>, record: &Ball) -> NearestFromClosestHit {
    let point = record.surface_point(hit.attributes().normal, &hit.object_to_world(), &hit.world_to_object());
    found_at(hit, Vec2::ZERO, point)
}

fn found_at<A: Attributes>(hit: &ClosestHit<Probe, A>, at: Vec2, point: SurfacePoint) -> NearestFromClosestHit {
    NearestFromClosestHit {
        instance: hit.instance_id().unwrap_or(0),
        primitive: hit.primitive_index(),
        kind: hit.hit_kind().get() as u32,
        t: hit.ray_tmax(),
        at,
        position: point.position,
        normal: point.normal,
        error: point.error,
    }
}

/// Reports that there is none.
#[miss]
fn nothing(_ms: &Miss<Probe>) -> NearestFromMiss {
    NearestFromMiss {
        primitive: 0,
        kind: 0,
        t: 0.0,
        at: Vec2::ZERO,
        position: Vec3::ZERO,
        normal: Vec3::ZERO,
        error: 0.0,
    }
}

pipeline! {
    /// Reports what rays meet.
    pub struct Probe {
        params: ProbeFrame,
        raygen: [probe, respawn],
        rays: { Nearest { miss: nothing } },
        hitgroups: {
            Surface on Triangles => { Nearest { closesthit: found } },
            Ball on Custom => { Nearest { intersection: ball::ball, closesthit: found_ball } },
        },
    }
}
