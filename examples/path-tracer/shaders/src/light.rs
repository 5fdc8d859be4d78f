//! The area light.

use crate::{PathTracer, RadianceAtClosestHit, RadianceFromClosestHit};
use optix_device_rs::prelude::*;

/// A parallelogram that emits light from its front.
#[derive(Clone, Copy, Debug, DeviceData)]
#[repr(C)]
pub struct AreaLight {
    /// A corner.
    pub corner: Vec3,
    /// From the corner along one side.
    pub side: Vec3,
    /// From the corner along the other.
    pub other: Vec3,
    /// Length 1, to where the light goes.
    pub normal: Vec3,
    /// Its area.
    pub area: f32,
    /// Radiance that it emits.
    pub emission: Vec3,
}

impl AreaLight {
    /// The light at `corner` with these sides; `side` x `other` points to where the light goes.
    pub fn new(corner: Vec3, side: Vec3, other: Vec3, emission: Vec3) -> Self {
        let across = side.cross(other);
        Self { corner, side, other, normal: across.normalize(), area: across.length(), emission }
    }
}

/// The surface of the light.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Emitter {
    /// Radiance that its front emits.
    pub emission: Vec3,
}

/// Ends a path at the light.
#[closesthit]
pub fn emitter(
    hit: &ClosestHit<PathTracer, Triangles>,
    record: &Emitter,
    ray: RadianceAtClosestHit,
) -> RadianceFromClosestHit {
    let counts = ray.sees_light && hit.face() == Face::Front;
    RadianceFromClosestHit {
        rng: ray.rng,
        light: if counts { record.emission } else { Vec3::ZERO },
        weight: Vec3::ZERO,
        origin: Vec3::ZERO,
        direction: Vec3::ZERO,
        specular: false,
        shadow_rays: 0,
    }
}
