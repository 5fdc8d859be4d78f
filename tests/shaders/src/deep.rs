//! What a program keeps across a trace that passes all triangles on its way.

use crate::ProbeRay;
use optix_device_rs::prelude::*;

/// How many numbers a program keeps.
pub const KEPT: u32 = 8;

/// The launch parameters.
#[launch_params]
pub struct DeepFrame {
    /// One for each launch index.
    pub rays: Slice<ProbeRay>,
    /// What the program reads before the trace and writes back after it: [`KEPT`] numbers for each launch index.
    pub kept: SliceMut<f32>,
    /// How often an any-hit program ran, for each launch index.
    pub met: SliceMut<u32>,
    /// The scene.
    pub world: Traversable,
}

/// A ray that nothing stops.
#[derive(Payload)]
pub struct Passing {
    /// How often an any-hit program ran.
    #[payload(write(caller, anyhit), read(anyhit, caller))]
    pub met: u32,
}

/// Triangles that rays pass.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Mist {}

/// Keeps numbers across a trace.
#[raygen]
fn keep(rg: &RayGen<Deep>) {
    let frame = rg.params();
    let index = rg.launch_index().x;
    let ray = frame.rays().get(index);
    let kept = |i: u32| frame.kept().get(KEPT * index + i);
    let before = (kept(0), kept(1), kept(2), kept(3), kept(4), kept(5), kept(6), kept(7));
    let (origin, direction) = (Vec3::from_array(ray.origin), Vec3::from_array(ray.direction));
    let ray = Ray::new(origin, direction).range(ray.tmin, ray.tmax);
    let passed = rg.trace::<Passing>(frame.world(), ray, PassingFromCaller { met: 0 });
    let put = |i: u32, number: f32| frame.kept().set(KEPT * index + i, number);
    put(0, before.0);
    put(1, before.1);
    put(2, before.2);
    put(3, before.3);
    put(4, before.4);
    put(5, before.5);
    put(6, before.6);
    put(7, before.7);
    frame.met().set(index, passed.met);
}

#[anyhit]
fn pass(_hit: &AnyHit<Deep, Triangles>, ray: PassingAtAnyHit) -> (Decision, PassingFromAnyHit) {
    (Decision::Ignore, PassingFromAnyHit { met: ray.met + 1 })
}

pipeline! {
    /// Rays that pass everything.
    pub struct Deep {
        params: DeepFrame,
        raygen: [keep],
        rays: { Passing {} },
        hitgroups: { Mist on Triangles => { Passing { anyhit: pass } } },
    }
}
