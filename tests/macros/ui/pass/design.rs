//! The program of the design page.
#![no_std]
#![deny(warnings, missing_docs, unsafe_code, unused_qualifications)]

// The test program itself has `std`.
extern crate std;

use optix_device_rs::prelude::*;

/// A camera.
#[derive(Clone, Copy, DeviceData)]
#[repr(C)]
pub struct Pinhole {
    /// Where it is.
    pub eye: Vec3,
    /// Half the width of the image plane at distance 1.
    pub half_width: f32,
}

impl Pinhole {
    fn ray(self, px: UVec2) -> Ray {
        Ray::new(self.eye, (px.as_vec2() * self.half_width).extend(-1.0))
    }
}

/// Launch parameters.
#[launch_params]
pub struct Frame {
    /// The image.
    pub film: SliceMut2d<Vec4>,
    /// The scene.
    pub world: Traversable,
    /// The camera.
    pub camera: Pinhole,
    /// When paths end.
    #[bound]
    pub max_bounces: u32,
}

/// Light along a ray.
#[derive(Payload)]
pub struct Radiance {
    /// What arrives.
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    /// Random numbers.
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
}

/// Visibility of a light.
#[derive(Payload)]
pub struct Shadow {
    /// Whether it is seen.
    #[payload(write(caller, miss), read(caller))]
    pub visible: bool,
}

/// Matt paint.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Lambert {
    /// Diffuse reflectance.
    pub albedo: Vec3,
    /// A normal per vertex.
    pub normals: Slice<Vec3>,
}

/// A leaf with holes.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Leaf {
    /// Opacity.
    pub opacity: f32,
}

/// A ball.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Ball {
    /// Centre and radius.
    pub sphere: Vec4,
}

/// The sky.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Sky {
    /// At the zenith.
    pub zenith: Vec3,
}

/// A hit on a ball.
#[derive(Clone, Copy, Attributes)]
pub struct BallHit {
    /// Outward.
    pub normal: Vec3,
}

#[raygen]
fn camera(rg: &RayGen<PathTracer>) {
    let frame = rg.params();
    let px = rg.launch_index().xy();
    let out = rg.trace::<Radiance>(
        frame.world(),
        frame.camera().ray(px),
        RadianceFromCaller { rng: Pcg32::new(px.x as u64, px.y as u64) },
    );
    frame.film().set(px, out.light.extend(1.0));
}

#[closesthit]
fn lambert(
    hit: &ClosestHit<PathTracer, Triangles>,
    record: &Lambert,
    mut ray: RadianceAtClosestHit,
) -> RadianceFromClosestHit {
    let towards = Vec3::new(ray.rng.next_f32(), 1.0, ray.rng.next_f32());
    let shadow = Ray::new(hit.world_ray_origin(), towards);
    let seen = hit.trace::<Shadow>(hit.params().world(), shadow, ShadowFromCaller { visible: false });
    let normal = record.normals.get(hit.primitive_index());
    let light = if seen.visible { record.albedo * normal.dot(towards) } else { Vec3::ZERO };
    RadianceFromClosestHit { light, rng: ray.rng }
}

#[closesthit]
fn leaf(_hit: &ClosestHit<PathTracer, Triangles>, record: &Leaf, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
    RadianceFromClosestHit { light: Vec3::splat(record.opacity), rng: ray.rng }
}

#[anyhit]
fn alpha(hit: &AnyHit<PathTracer, Triangles>, record: &Leaf) -> Decision {
    if hit.barycentrics().x > record.opacity { Decision::Ignore } else { Decision::Accept }
}

#[intersection]
fn ball(isect: &Intersection<PathTracer, BallHit>, record: &Ball) {
    let to_centre = record.sphere.xyz() - isect.object_ray_origin();
    isect.report(to_centre.dot(isect.object_ray_direction()), 0, BallHit { normal: Vec3::Y });
}

#[closesthit]
fn ball_shade(hit: &ClosestHit<PathTracer, BallHit>, _: &Ball, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
    RadianceFromClosestHit { light: hit.attributes().normal, rng: ray.rng }
}

#[miss]
fn sky(ms: &Miss<PathTracer>, record: &Sky) -> RadianceFromMiss {
    RadianceFromMiss { light: record.zenith * ms.world_ray_direction().y }
}

#[miss]
fn lit(_ms: &Miss<PathTracer>) -> ShadowFromMiss {
    ShadowFromMiss { visible: true }
}

pipeline! {
    /// A path tracer.
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: {
            Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} },
            Leaf    on Triangles => { Radiance { closesthit: leaf, anyhit: alpha }, Shadow { anyhit: alpha } },
            Ball    on Custom    => { Radiance { intersection: ball, closesthit: ball_shade }, Shadow { intersection: ball } },
        },
    }
}

fn main() {
    assert_eq!(PathTracer::DESCRIPTION.hitgroups.len(), 3);
}
