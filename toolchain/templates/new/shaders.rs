//! The device programs of {{name}}: they run on the GPU and, compiled for the host, on the CPU.
#![no_std]

use optix_device_rs::prelude::*;

/// What a launch is given. A program reads each field through `params()`.
#[launch_params]
pub struct Frame {
    /// The picture.
    pub film: SliceMut2d<Vec4>,
    /// What rays are traced against.
    pub world: Traversable,
    /// Where rays start.
    pub eye: Vec3,
}

/// What a ray brings back: the programs that `write` it must return it, the caller may `read` it.
#[derive(Payload)]
pub struct Radiance {
    /// The colour seen.
    #[payload(write(closesthit, miss), read(caller))]
    pub colour: Vec3,
}

/// A material: the record that its programs read from the shader binding table.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Paint {
    /// Colours at the three corners of each triangle.
    pub corners: [Vec3; 3],
}

/// The record of the miss program.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Sky {
    /// The colour at the horizon.
    pub horizon: Vec3,
    /// The colour above.
    pub zenith: Vec3,
}

/// Runs once per pixel.
#[raygen]
fn camera(rg: &RayGen<Renderer>) {
    let frame = rg.params();
    let px = rg.launch_index().xy();
    let size = rg.launch_dimensions().xy().as_vec2();
    let at = (px.as_vec2() + 0.5 - 0.5 * size) / size.y;
    let direction = Vec3::new(at.x, -at.y, -1.0).normalize();
    let seen = rg.trace::<Radiance>(frame.world(), Ray::new(frame.eye(), direction), ());
    frame.film().set(px, seen.colour.extend(1.0));
}

/// Runs where a ray hits a triangle.
#[closesthit]
fn paint(hit: &ClosestHit<Renderer, Triangles>, record: &Paint) -> RadianceFromClosestHit {
    let Vec2 { x: u, y: v } = hit.barycentrics();
    let [a, b, c] = record.corners;
    RadianceFromClosestHit { colour: a * (1.0 - u - v) + b * u + c * v }
}

/// Runs where a ray hits nothing.
#[miss]
fn sky(ms: &Miss<Renderer>, record: &Sky) -> RadianceFromMiss {
    let height = ms.world_ray_direction().y * 0.5 + 0.5;
    RadianceFromMiss { colour: record.horizon.lerp(record.zenith, height) }
}

pipeline! {
    /// All programs, and what each reads.
    pub struct Renderer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky } },
        hitgroups: { Paint on Triangles => { Radiance { closesthit: paint } } },
    }
}
