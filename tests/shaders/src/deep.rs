//! What a program keeps across a trace that passes all triangles on its way.

use crate::ProbeRay;
use optix_device_rs::prelude::*;

/// What the program reads before the trace and writes back after it.
#[derive(Clone, Copy, Debug, PartialEq, Element)]
#[repr(C)]
pub struct Kept {
    /// Any numbers.
    pub numbers: Mat4,
    /// Any words.
    pub words: UVec3,
    /// How often an any-hit program ran.
    pub met: u32,
}

/// The launch parameters.
#[launch_params]
pub struct DeepFrame {
    /// One for each launch index.
    pub rays: Slice<ProbeRay>,
    /// Likewise.
    pub kept: SliceMut<Kept>,
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

/// Keeps words across a trace: more than there are registers for, with what else lives there.
#[raygen]
fn keep(rg: &RayGen<Deep>) {
    let frame = rg.params();
    let index = rg.launch_index().x;
    let ray = frame.rays().get(index);
    let before = frame.kept().get(index);
    let (origin, direction) = (Vec3::from_array(ray.origin), Vec3::from_array(ray.direction));
    let ray = Ray::new(origin, direction).range(ray.tmin, ray.tmax);
    let passed = rg.trace::<Passing>(frame.world(), ray, PassingFromCaller { met: 0 });
    frame.kept().set(index, Kept { met: passed.met, ..before });
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
