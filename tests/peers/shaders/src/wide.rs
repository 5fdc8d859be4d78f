//! Paths that carry their whole state through a payload of 24 words.

use crate::middle;
use optix_device_rs::prelude::*;
use path_tracer_shaders::{Pinhole, cosine};

/// The launch parameters.
#[launch_params]
pub struct WideFrame {
    /// Radiance.
    pub film: SliceMut2d<Vec4>,
    /// Albedo of the first surface.
    pub albedo: SliceMut2d<Vec4>,
    /// Normal of the first surface.
    pub normal: SliceMut2d<Vec4>,
    /// The scene.
    pub world: Traversable,
    /// The camera.
    pub camera: Pinhole,
    /// Paths per pixel.
    pub samples: u32,
    /// Longest path.
    pub segments: u32,
}

/// A path: 24 words.
#[derive(Payload)]
pub struct Path {
    /// Random sequence.
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
    /// What the rest of the path is weighted by.
    #[payload(write(caller, closesthit), read(closesthit, miss, caller))]
    pub weight: Vec3,
    /// Radiance so far.
    #[payload(write(caller, miss), read(miss, caller))]
    pub light: Vec3,
    /// Where the next segment begins.
    #[payload(write(caller, closesthit), read(caller))]
    pub origin: Vec3,
    /// Its direction.
    #[payload(write(caller, closesthit), read(caller))]
    pub direction: Vec3,
    /// Albedo of the first surface.
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub albedo: Vec3,
    /// Normal of the first surface.
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub normal: Vec3,
    /// Segments so far.
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub segment: u32,
    /// Whether the path goes on.
    #[payload(write(caller, miss), read(caller))]
    pub alive: bool,
}

/// A diffuse surface.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Paint {
    /// Share of light that it reflects, per colour.
    pub albedo: Vec3,
}

#[raygen]
fn camera(rg: &RayGen<Wide>) {
    let frame = rg.params();
    let px = rg.launch_index().xy();
    let size = rg.launch_dimensions().xy();
    let first = frame.camera().ray(middle(px, size));
    let (mut light, mut albedo, mut normal) = (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);
    let mut sample = 0;
    while sample < frame.samples() {
        let mut path = PathFromCaller {
            rng: Pcg32::hashed((px.y as u64 * size.x as u64 + px.x as u64) << 32 | sample as u64, 0),
            weight: Vec3::ONE,
            light: Vec3::ZERO,
            origin: first.origin,
            direction: first.direction,
            albedo: Vec3::ZERO,
            normal: Vec3::ZERO,
            segment: 0,
            alive: true,
        };
        while path.alive && path.segment < frame.segments() {
            let p = rg.trace::<Path>(frame.world(), Ray::new(path.origin, path.direction), path);
            path = PathFromCaller {
                rng: p.rng,
                weight: p.weight,
                light: p.light,
                origin: p.origin,
                direction: p.direction,
                albedo: p.albedo,
                normal: p.normal,
                segment: p.segment,
                alive: p.alive,
            };
        }
        light += path.light;
        albedo += path.albedo;
        normal += path.normal;
        sample += 1;
    }
    frame.film().set(px, light.extend(0.0));
    frame.albedo().set(px, albedo.extend(0.0));
    frame.normal().set(px, normal.extend(0.0));
}

#[closesthit]
fn paint(hit: &ClosestHit<Wide, Triangles>, record: &Paint, path: PathAtClosestHit) -> PathFromClosestHit {
    let point = hit.surface_point();
    let normal = if point.normal.dot(hit.world_ray_direction()) > 0.0 { -point.normal } else { point.normal };
    let mut rng = path.rng;
    let direction = Onb::around(normal).to_world(cosine(rng.next_vec2()));
    let first = path.segment == 0;
    PathFromClosestHit {
        rng,
        weight: path.weight * record.albedo,
        origin: point.origin(direction),
        direction,
        albedo: if first { record.albedo } else { path.albedo },
        normal: if first { normal } else { path.normal },
        segment: path.segment + 1,
    }
}

#[miss]
fn sky(ms: &Miss<Wide>, path: PathAtMiss) -> PathFromMiss {
    let up = 0.5 * ms.world_ray_direction().y + 0.5;
    PathFromMiss { light: path.light + path.weight * (0.25 + up), alive: false }
}

pipeline! {
    /// Paths with a wide payload.
    pub struct Wide {
        params: WideFrame,
        raygen: [camera],
        rays: { Path { miss: sky } },
        hitgroups: { Paint on Triangles => { Path { closesthit: paint } } },
    }
}
