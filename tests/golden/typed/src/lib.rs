//! Device programs that use one thing each: what they compile to is compared with programs written by hand.
#![no_std]

use optix_device_rs::prelude::*;

/// Fields of many types.
#[launch_params]
pub struct Frame {
    /// Where programs write to.
    pub film: SliceMut<Vec4>,
    /// The scene.
    pub world: Traversable,
    /// A number.
    pub scale: f32,
    /// A number that may be specialised away.
    #[bound]
    pub count: u32,
    /// A vector.
    pub sun: Vec3,
    /// A byte.
    pub flag: bool,
    /// Half a word.
    pub tag: u16,
    /// Two words.
    pub seed: u64,
}

/// Written by closest-hit and miss, carried by the caller, counted by any-hit.
#[derive(Payload)]
pub struct Radiance {
    /// Three words.
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    /// There and back.
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub seed: u32,
    /// Candidates met.
    #[payload(write(caller, anyhit), read(anyhit, closesthit))]
    pub layers: u32,
}

/// A record of two fields.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Lambert {
    /// A vector.
    pub albedo: Vec3,
    /// A number.
    pub id: u32,
}

/// A record for triangles whose corners are fetched.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Corners {
    /// A number.
    pub weight: f32,
}

/// A record for a custom primitive.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Ball {
    /// A number.
    pub radius: f32,
}

/// A miss program's record.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Sky {
    /// A vector.
    pub light: Vec3,
}

/// A callable's record.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Blend {
    /// Another callable.
    pub of: Callable<fn(Vec3, f32) -> Vec3>,
    /// A number.
    pub scale: f32,
}

/// Four attribute words.
#[derive(Clone, Copy, Attributes)]
pub struct BallHit {
    /// Three words.
    pub normal: Vec3,
    /// One word.
    pub part: u32,
}

/// Launch index and dimensions.
#[raygen]
fn index(rg: &RayGen<Golden>) {
    let (at, size) = (rg.launch_index(), rg.launch_dimensions());
    let value = Vec4::new(at.x as f32, at.y as f32, size.x as f32, size.y as f32);
    rg.params().film().set(at.y * size.x + at.x, value);
}

/// Parameters of four bytes and vectors of them.
#[raygen]
fn words(rg: &RayGen<Golden>) {
    let frame = rg.params();
    let value = frame.sun() * frame.scale();
    frame.film().set(frame.count(), value.extend(1.0));
}

/// Parameters smaller than four bytes.
#[raygen]
fn bytes(rg: &RayGen<Golden>) {
    let frame = rg.params();
    let value = if frame.flag() { frame.scale() } else { frame.tag() as f32 };
    frame.film().set(rg.launch_index().x, Vec4::splat(value));
}

/// A parameter of eight bytes.
#[raygen]
fn wide(rg: &RayGen<Golden>) {
    let frame = rg.params();
    let state = frame.seed().wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
    frame.film().set(rg.launch_index().x, Vec4::splat((state >> 40) as f32));
}

/// A trace call: payload to and from the caller.
#[raygen]
fn caller(rg: &RayGen<Golden>) {
    let frame = rg.params();
    let at = rg.launch_index();
    let ray = Ray::new(Vec3::new(at.x as f32, at.y as f32, 0.0), frame.sun()).range(0.5, 100.0);
    let out = rg.trace::<Radiance>(frame.world(), ray, RadianceFromCaller { seed: at.x, layers: 7 });
    frame.film().set(at.x, out.light.extend(out.seed as f32));
}

/// Payload both ways, and a record.
#[closesthit]
fn shade(hit: &ClosestHit<Golden, Triangles>, record: &Lambert, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
    let seed = ray.seed.wrapping_mul(747_796_405).wrapping_add(ray.layers ^ record.id);
    RadianceFromClosestHit { light: record.albedo * hit.ray_tmax(), seed }
}

/// A decision, and payload both ways.
#[anyhit]
fn cut_out(hit: &AnyHit<Golden, Triangles>, record: &Lambert, ray: RadianceAtAnyHit) -> (Decision, RadianceFromAnyHit) {
    let part = RadianceFromAnyHit { layers: ray.layers + 1 };
    if hit.primitive_index() == record.id {
        (Decision::Ignore, part)
    } else if hit.barycentrics().x > 0.5 {
        (Decision::Terminate, part)
    } else {
        (Decision::Accept, part)
    }
}

/// The surface's vertices.
#[closesthit]
fn corners(hit: &ClosestHit<Golden, Triangles>, record: &Corners, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
    let [a, b, c] = hit.vertices();
    RadianceFromClosestHit { light: (a + b + c) * record.weight, seed: ray.seed }
}

/// Reports attributes.
#[intersection]
fn ball(isect: &Intersection<Golden, BallHit>, record: &Ball) {
    let (origin, direction) = (isect.object_ray_origin(), isect.object_ray_direction());
    let t = record.radius - origin.x;
    isect.report(t, 3, BallHit { normal: direction * t, part: isect.primitive_index() });
}

/// Reads attributes.
#[closesthit]
fn ball_shade(hit: &ClosestHit<Golden, BallHit>, record: &Ball, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
    let attributes = hit.attributes();
    RadianceFromClosestHit { light: attributes.normal * record.radius, seed: ray.seed ^ attributes.part }
}

/// Payload written, and a record of its own.
#[miss]
fn sky(ms: &Miss<Golden>, record: &Sky) -> RadianceFromMiss {
    RadianceFromMiss { light: record.light * ms.world_ray_direction().y }
}

/// Arguments, a result, a record, and a call of another callable.
#[direct_callable]
fn blend(dc: &DirectCallable<Golden>, record: &Blend, at: Vec3, share: f32) -> Vec3 {
    record.of.call(dc, at * record.scale, share) * share
}

pipeline! {
    /// All of them.
    pub struct Golden {
        params: Frame,
        raygen: [index, words, bytes, wide, caller],
        rays: { Radiance { miss: sky } },
        hitgroups: {
            Lambert on Triangles => { Radiance { closesthit: shade, anyhit: cut_out } },
            Corners on Triangles => { Radiance { closesthit: corners } },
            Ball on Custom => { Radiance { intersection: ball, closesthit: ball_shade } },
        },
        direct_callables: [blend],
    }
}
