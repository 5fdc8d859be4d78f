//! The device programs of the path tracer: a box lit by an area light, with a diffuse mesh, a mirror ball as a custom
//! primitive and a leaf that is cut out by an any-hit program.
//!
//! Paths are followed in a loop by the ray-generation program; a closest-hit program returns what its surface adds and
//! where the path goes on, and traces one shadow ray. So trace calls nest two deep, and every quantity that crosses a
//! trace call is a payload field with a writer and a reader.
#![no_std]

pub mod ball;
mod camera;
mod leaf;
mod light;
mod surface;

pub use ball::Ball;
pub use camera::Pinhole;
pub use leaf::Leaf;
pub use light::{AreaLight, Emitter};
pub use surface::{Lambert, Smooth, SmoothHost, cosine};

use optix_device_rs::prelude::*;

/// The launch parameters.
#[launch_params]
pub struct Frame {
    /// Per pixel: the sum of this pass's samples (red, green, blue), and the rays traced for it.
    pub sum: SliceMut2d<Vec4>,
    /// Per pixel: the sum of the squares of this pass's samples.
    pub squares: SliceMut2d<Vec4>,
    /// The scene.
    pub world: Traversable,
    /// The camera.
    pub camera: Pinhole,
    /// The light.
    pub light: AreaLight,
    /// Number of the first sample of this pass: each sample has a random sequence of its own.
    pub first_sample: u32,
    /// Samples of this pass.
    pub samples: u32,
    /// Chooses the random sequences.
    pub seed: u64,
    /// How many times a path may bounce.
    #[bound]
    pub max_bounces: u32,
}

/// What a path segment carries.
#[derive(Payload)]
pub struct Radiance {
    /// The path's random sequence.
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
    /// Whether light that is hit counts: not if a shadow ray has already counted it.
    #[payload(write(caller), read(closesthit))]
    pub sees_light: bool,
    /// Radiance that the surface sends back, emitted and reflected from the light.
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    /// What the rest of the path is weighted by; zero ends it.
    #[payload(write(closesthit, miss), read(caller))]
    pub weight: Vec3,
    /// Where the path goes on.
    #[payload(write(closesthit, miss), read(caller))]
    pub origin: Vec3,
    /// In which direction.
    #[payload(write(closesthit, miss), read(caller))]
    pub direction: Vec3,
    /// Whether the next segment counts light that it hits.
    #[payload(write(closesthit, miss), read(caller))]
    pub specular: bool,
    /// Shadow rays traced.
    #[payload(write(closesthit, miss), read(caller))]
    pub shadow_rays: u32,
}

/// Whether the light is seen.
#[derive(Payload)]
pub struct Shadow {
    /// True if nothing is between.
    #[payload(write(caller, miss), read(caller))]
    pub visible: bool,
}

/// Nothing is hit: the box is open at the front, and it is dark outside.
#[miss]
fn dark(_ms: &Miss<PathTracer>) -> RadianceFromMiss {
    RadianceFromMiss {
        light: Vec3::ZERO,
        weight: Vec3::ZERO,
        origin: Vec3::ZERO,
        direction: Vec3::ZERO,
        specular: false,
        shadow_rays: 0,
    }
}

/// Nothing is between a surface and the light.
#[miss]
fn lit(_ms: &Miss<PathTracer>) -> ShadowFromMiss {
    ShadowFromMiss { visible: true }
}

pipeline! {
    /// The path tracer.
    pub struct PathTracer {
        params: Frame,
        raygen: [camera::camera],
        rays: {
            Radiance { miss: dark },
            Shadow { miss: lit },
        },
        hitgroups: {
            Lambert on Triangles => { Radiance { closesthit: surface::lambert }, Shadow {} },
            Smooth on Triangles => { Radiance { closesthit: surface::smooth }, Shadow {} },
            Emitter on Triangles => { Radiance { closesthit: light::emitter }, Shadow {} },
            Leaf on Triangles => {
                Radiance { closesthit: leaf::leaf, anyhit: leaf::cut_out },
                Shadow { anyhit: leaf::cut_out },
            },
            Ball on Custom => {
                Radiance { intersection: ball::ball, closesthit: ball::mirror },
                Shadow { intersection: ball::ball },
            },
        },
    }
}
