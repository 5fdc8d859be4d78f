//! A mirror ball: a custom primitive with an intersection program, which serves any pipeline.

use crate::{PathTracer, RadianceAtClosestHit, RadianceFromClosestHit};
use optix_device_rs::prelude::*;
use optix_device_rs::surface::gamma;

/// A ball in object space, around the origin.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Ball {
    /// Its radius.
    pub radius: f32,
    /// Share of light that it reflects, per colour.
    pub reflectance: Vec3,
}

impl Ball {
    /// The point with this object-space normal.
    pub fn surface_point(&self, normal: Vec3, to_world: &Transform, to_object: &Transform) -> SurfacePoint {
        // The intersection squares distances up to the radius: its roundings move the surface by some ulp of the radius.
        let error = Vec3::splat(self.radius * gamma(16));
        SurfacePoint::of_object(normal * self.radius, normal, error, to_world, to_object)
    }
}

/// A hit on the ball.
#[derive(Clone, Copy, Debug, Attributes)]
pub struct BallHit {
    /// Unit normal in object space, outwards.
    pub normal: Vec3,
}

/// Intersects the ball, with the discriminant from the distance of centre and ray, which does not cancel (Haines et al. 2019,
/// "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, chapter 7).
#[intersection]
pub fn ball<P: Pipeline>(isect: &Intersection<P, BallHit>, record: &Ball) {
    let (o, d) = (isect.object_ray_origin(), isect.object_ray_direction());
    let radius = record.radius;
    let dd = d.length_squared();
    let b = -o.dot(d);
    let nearest = o + d * (b / dd);
    let discriminant = radius * radius - nearest.length_squared();
    if discriminant < 0.0 {
        return;
    }
    let root = (discriminant * dd).sqrt();
    let q = b + root.copysign(b);
    let c = o.length_squared() - radius * radius;
    let (t0, t1) = (c / q, q / dd);
    let (near, far) = if t0 < t1 { (t0, t1) } else { (t1, t0) };
    let hit = |t: f32| BallHit { normal: ((o + d * t) / radius).normalize() };
    if !isect.report(near, 0, hit(near)) {
        isect.report(far, 1, hit(far));
    }
}

/// Reflects the path.
#[closesthit]
pub fn mirror(
    hit: &ClosestHit<PathTracer, BallHit>,
    record: &Ball,
    ray: RadianceAtClosestHit,
) -> RadianceFromClosestHit {
    let point = record.surface_point(hit.attributes().normal, &hit.object_to_world(), &hit.world_to_object());
    let incoming = hit.world_ray_direction();
    let direction = incoming - point.normal * (2.0 * incoming.dot(point.normal));
    RadianceFromClosestHit {
        rng: ray.rng,
        light: Vec3::ZERO,
        weight: record.reflectance,
        origin: point.origin(direction),
        direction,
        specular: true,
        shadow_rays: 0,
    }
}
