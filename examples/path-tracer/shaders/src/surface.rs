//! Diffuse surfaces.

use crate::{PathTracer, RadianceAtClosestHit, RadianceFromClosestHit, Shadow, ShadowFromCaller};
use optix_device_rs::math::sin_cos_turns;
use optix_device_rs::prelude::*;

/// A diffuse surface, shaded by the normal of its triangles.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Lambert {
    /// Share of light that it reflects, per colour.
    pub albedo: Vec3,
}

/// A diffuse surface, shaded by normals at its vertices.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Smooth {
    /// Share of light that it reflects, per colour.
    pub albedo: Vec3,
    /// Normals in object space, per vertex.
    pub normals: Slice<Vec3>,
    /// Vertices, per triangle.
    pub indices: Slice<[u32; 3]>,
}

/// Shades a flat triangle.
#[closesthit]
pub fn lambert(
    hit: &ClosestHit<PathTracer, Triangles>,
    record: &Lambert,
    ray: RadianceAtClosestHit,
) -> RadianceFromClosestHit {
    let point = hit.surface_point();
    diffuse(hit, &point, point.normal, record.albedo, ray)
}

/// Shades a triangle with normals at its vertices.
#[closesthit]
pub fn smooth(
    hit: &ClosestHit<PathTracer, Triangles>,
    record: &Smooth,
    ray: RadianceAtClosestHit,
) -> RadianceFromClosestHit {
    let [a, b, c] = record.indices.get(hit.primitive_index()).map(|i| record.normals.get(i));
    let Vec2 { x: u, y: v } = hit.barycentrics();
    let normal = a * (1.0 - u - v) + b * u + c * v;
    let point = hit.surface_point();
    let shading = hit.world_to_object().normal(normal).normalize_or(point.normal);
    diffuse(hit, &point, shading, record.albedo, ray)
}

/// Light reflected from the area light, and a direction to go on in, by the cosine.
pub(crate) fn diffuse(
    hit: &ClosestHit<PathTracer, Triangles>,
    point: &SurfacePoint,
    shading: Vec3,
    albedo: Vec3,
    ray: RadianceAtClosestHit,
) -> RadianceFromClosestHit {
    let mut rng = ray.rng;
    // Both normals on the side that the ray came from.
    let incoming = hit.world_ray_direction();
    let geometric = if point.normal.dot(incoming) > 0.0 { -point.normal } else { point.normal };
    let normal = if shading.dot(geometric) < 0.0 { -shading } else { shading };
    // A shading normal that the ray sees from behind is no use.
    let normal = if normal.dot(incoming) > 0.0 { geometric } else { normal };

    // The way on before the shadow ray: what is kept over a trace call costs memory traffic.
    let on_light = rng.next_vec2();
    let direction = Onb::around(normal).to_world(cosine(rng.next_vec2()));
    // A direction into the surface, possible where the shading normal leans over, carries nothing.
    let weight = Vec3::select(BVec3::splat(direction.dot(geometric) > 0.0), albedo, Vec3::ZERO);
    let origin = point.origin(direction);
    let (light, shadow_rays) = direct(hit, point, geometric, normal, on_light);
    RadianceFromClosestHit { rng, light: light * albedo, weight, origin, direction, specular: false, shadow_rays }
}

/// Light from a point of the area light, reflected by a white diffuse surface, and the shadow rays it took.
fn direct(
    hit: &ClosestHit<PathTracer, Triangles>,
    point: &SurfacePoint,
    geometric: Vec3,
    normal: Vec3,
    at: Vec2,
) -> (Vec3, u32) {
    let frame = hit.params();
    let area_light = frame.light();
    let to = area_light.corner + area_light.side * at.x + area_light.other * at.y;
    let d = to - point.position;
    let distance2 = d.length_squared();
    let cos_light = -area_light.normal.dot(d);
    let cos_surface = normal.dot(d);
    if cos_light <= 0.0 || cos_surface <= 0.0 || geometric.dot(d) <= 0.0 {
        return (Vec3::ZERO, 0);
    }
    // The light's own point is as exact as its coordinates.
    let error = to.abs().max_element() * optix_device_rs::surface::gamma(16);
    let end = SurfacePoint::new(to, area_light.normal, error);
    let shadow = point.ray_to(&end).flags(RayFlags::NONE.terminate_on_first_hit());
    let share = cos_light * cos_surface / (core::f32::consts::PI * distance2 * distance2);
    let seen = hit.trace_without_closesthit::<Shadow>(frame.world(), shadow, ShadowFromCaller { visible: false });
    if !seen.visible {
        return (Vec3::ZERO, 1);
    }
    // area * cos * cos / (pi * distance^2), with both cosines still times the distance. The light is asked for again, since
    // it need not be kept over the trace call then.
    let light = frame.light();
    (light.emission * (light.area * share), 1)
}

/// A direction around +z, by the cosine: a point of the unit disk, raised (Malley's method).
pub fn cosine(at: Vec2) -> Vec3 {
    let radius = at.x.sqrt();
    let (sin, cos) = sin_cos_turns(at.y);
    Vec3::new(radius * cos, radius * sin, (1.0 - at.x).max(0.0).sqrt())
}
