//! The camera and the paths that begin at it.

use crate::{PathTracer, Radiance, RadianceFromCaller};
use optix_device_rs::prelude::*;

/// A pinhole camera.
#[derive(Clone, Copy, Debug, DeviceData)]
#[repr(C)]
pub struct Pinhole {
    /// The pinhole.
    pub eye: Vec3,
    /// From the eye to the middle of the picture.
    pub forward: Vec3,
    /// From the middle of the picture to its right edge.
    pub right: Vec3,
    /// From the middle of the picture to its top edge.
    pub up: Vec3,
}

impl Pinhole {
    /// A camera at `eye` that looks at `target`, `up` being upwards in the picture, with a vertical field of view in radians
    /// and a picture `aspect` times as wide as high.
    pub fn look_at(eye: Vec3, target: Vec3, up: Vec3, field_of_view: f32, aspect: f32) -> Self {
        let forward = (target - eye).normalize();
        let right = forward.cross(up).normalize();
        let half = (0.5 * field_of_view).sin() / (0.5 * field_of_view).cos();
        Self { eye, forward, right: right * (half * aspect), up: right.cross(forward) * half }
    }

    /// The ray through a point of the picture, both coordinates from 0 to 1, from the top left.
    pub fn ray(&self, at: Vec2) -> Ray {
        let direction = self.forward + self.right * (2.0 * at.x - 1.0) + self.up * (1.0 - 2.0 * at.y);
        Ray::new(self.eye, direction.normalize())
    }
}

/// Takes the pass's samples of a pixel.
#[raygen]
pub fn camera(rg: &RayGen<PathTracer>) {
    let frame = rg.params();
    let px = rg.launch_index().xy();
    let size = rg.launch_dimensions().xy();
    let (mut sum, mut squares) = (Vec3::ZERO, Vec3::ZERO);
    let mut rays = 0;
    let mut sample = 0;
    while sample < frame.samples() {
        let number = frame.first_sample() + sample;
        let pixel = (px.y as u64 * size.x as u64 + px.x as u64) << 32 | number as u64;
        let mut rng = Pcg32::hashed(pixel, frame.seed());
        let at = (px.as_vec2() + rng.next_vec2()) / size.as_vec2();
        let (light, traced) = path(rg, frame.camera().ray(at), rng);
        sum += light;
        squares += light * light;
        rays += traced;
        sample += 1;
    }
    frame.sum().set(px, sum.extend(rays as f32));
    frame.squares().set(px, squares.extend(0.0));
}

/// Follows a path; returns its radiance and the rays traced.
fn path(rg: &RayGen<PathTracer>, mut ray: Ray, mut rng: Pcg32) -> (Vec3, u32) {
    let frame = rg.params();
    let (mut light, mut weight) = (Vec3::ZERO, Vec3::ONE);
    let mut sees_light = true;
    let mut rays = 0;
    let mut bounce = 0;
    loop {
        let hit = rg.trace::<Radiance>(frame.world(), ray, RadianceFromCaller { rng, sees_light });
        light += weight * hit.light;
        rays += 1 + hit.shadow_rays;
        weight *= hit.weight;
        if bounce == frame.max_bounces() || weight == Vec3::ZERO {
            return (light, rays);
        }
        rng = hit.rng;
        sees_light = hit.specular;
        ray = Ray::new(hit.origin, hit.direction);
        bounce += 1;
    }
}
