//! Ambient occlusion: one camera ray a pixel, and many short rays that any hit ends.

use crate::middle;
use optix_device_rs::prelude::*;
use path_tracer_shaders::{Pinhole, cosine};

/// The launch parameters.
#[launch_params]
pub struct OcclusionFrame {
    /// Share of the rays that met nothing.
    pub film: SliceMut2d<f32>,
    /// The scene.
    pub world: Traversable,
    /// The camera.
    pub camera: Pinhole,
    /// Occlusion rays per pixel.
    pub samples: u32,
    /// How far they reach.
    pub radius: f32,
}

/// The surface that a camera ray meets.
#[derive(Payload)]
pub struct Surface {
    /// Where.
    #[payload(write(closesthit, miss), read(caller))]
    pub position: Vec3,
    /// Unit normal towards the ray.
    #[payload(write(closesthit, miss), read(caller))]
    pub normal: Vec3,
    /// Error bound of the position; negative for a miss.
    #[payload(write(closesthit, miss), read(caller))]
    pub error: f32,
}

/// Whether nothing is near.
#[derive(Payload)]
pub struct Open {
    /// True if nothing was hit.
    #[payload(write(caller, miss), read(caller))]
    pub open: bool,
}

/// The one material.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Clay {}

/// Takes the samples of a pixel.
#[raygen]
fn camera(rg: &RayGen<Occlusion>) {
    let frame = rg.params();
    let px = rg.launch_index().xy();
    let size = rg.launch_dimensions().xy();
    let hit = rg.trace::<Surface>(frame.world(), frame.camera().ray(middle(px, size)), ());
    let mut open = 0;
    if hit.error >= 0.0 {
        let point = SurfacePoint::new(hit.position, hit.normal, hit.error);
        let basis = Onb::around(hit.normal);
        let mut rng = Pcg32::hashed(px.y as u64 * size.x as u64 + px.x as u64, 0);
        let flags = RayFlags::NONE.terminate_on_first_hit();
        let mut sample = 0;
        while sample < frame.samples() {
            let direction = basis.to_world(cosine(rng.next_vec2()));
            let ray = point.ray(direction).range(0.0, frame.radius()).flags(flags);
            open += rg.trace_without_closesthit::<Open>(frame.world(), ray, OpenFromCaller { open: false }).open as u32;
            sample += 1;
        }
    }
    frame.film().set(px, open as f32 / frame.samples() as f32);
}

/// Says where the surface is.
#[closesthit]
fn clay(hit: &ClosestHit<Occlusion, Triangles>) -> SurfaceFromClosestHit {
    let SurfacePoint { position, normal, error, .. } = hit.surface_point();
    let normal = if normal.dot(hit.world_ray_direction()) > 0.0 { -normal } else { normal };
    SurfaceFromClosestHit { position, normal, error }
}

#[miss]
fn nothing(_ms: &Miss<Occlusion>) -> SurfaceFromMiss {
    SurfaceFromMiss { position: Vec3::ZERO, normal: Vec3::ZERO, error: -1.0 }
}

#[miss]
fn free(_ms: &Miss<Occlusion>) -> OpenFromMiss {
    OpenFromMiss { open: true }
}

pipeline! {
    /// Ambient occlusion.
    pub struct Occlusion {
        params: OcclusionFrame,
        raygen: [camera],
        rays: { Surface { miss: nothing }, Open { miss: free } },
        hitgroups: {
            Clay on Triangles => { Surface { closesthit: clay }, Open {} },
        },
    }
}
