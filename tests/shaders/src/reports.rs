//! An intersection program that reports twice, and an any-hit program that runs meanwhile and writes the same payload field.

use optix_device_rs::prelude::*;

/// The launch parameters.
#[launch_params]
pub struct ReportFrame {
    /// Per launch index: what came back in the payload's two fields.
    pub counts: SliceMut<[u32; 2]>,
    /// Per launch index and report: what the any-hit program found in the two fields.
    pub found: SliceMut<[u32; 2]>,
    /// Per launch index: the time that intersection, any-hit, closest-hit and miss program see; -1 where it did not run.
    pub times: SliceMut<[f32; 4]>,
    /// The scene.
    pub world: Traversable,
    /// The time that rays have.
    pub time: f32,
}

/// What is counted.
#[derive(Payload)]
pub struct Counts {
    /// By the intersection and by the any-hit program.
    #[payload(write(caller, anyhit, intersection), read(caller, anyhit, intersection))]
    pub both: u32,
    /// By the any-hit program.
    #[payload(write(caller, anyhit), read(caller, anyhit))]
    pub anyhit: u32,
}

/// Nothing.
#[derive(Clone, Copy, Attributes)]
pub struct Nothing {}

/// A box.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Cell {}

/// Where both fields begin.
pub const BEGIN: u32 = 100;
/// What the intersection program adds.
pub const ADDED: u32 = 10;

/// Traces a ray down: hits are accepted at even launch indices and ignored at odd ones.
#[raygen]
fn count(rg: &RayGen<Reports>) {
    let (frame, index) = (rg.params(), rg.launch_index().x);
    let ray = Ray::new(Vec3::Z * 4.0, Vec3::NEG_Z).time(frame.time());
    let counts = rg.trace::<Counts>(frame.world(), ray, CountsFromCaller { both: BEGIN, anyhit: BEGIN });
    frame.counts().set(index, [counts.both, counts.anyhit]);
}

macro_rules! time {
    ($at:ident, $program:literal) => {{
        let (times, index) = ($at.params().times(), $at.launch_index().x);
        let mut all = times.get(index);
        all[$program] = $at.ray_time();
        times.set(index, all);
    }};
}

#[intersection]
fn twice(isect: &Intersection<Reports, Nothing>, ray: CountsAtIntersection) -> CountsFromIntersection {
    time!(isect, 0);
    isect.report(4.0, 0, Nothing {});
    isect.report(3.5, 1, Nothing {});
    CountsFromIntersection { both: ray.both + ADDED }
}

#[anyhit]
fn each(hit: &AnyHit<Reports, Nothing>, ray: CountsAtAnyHit) -> (Decision, CountsFromAnyHit) {
    time!(hit, 1);
    let index = hit.launch_index().x;
    hit.params().found().set(index * 2 + u32::from(hit.hit_kind().get()), [ray.both, ray.anyhit]);
    let decision = if index.is_multiple_of(2) { Decision::Accept } else { Decision::Ignore };
    (decision, CountsFromAnyHit { both: ray.both + 1, anyhit: ray.anyhit + 1 })
}

#[closesthit]
fn nearest(hit: &ClosestHit<Reports, Nothing>) {
    time!(hit, 2);
}

#[miss]
fn none(ms: &Miss<Reports>) {
    time!(ms, 3);
}

pipeline! {
    /// Counts reports.
    pub struct Reports {
        params: ReportFrame,
        raygen: [count],
        rays: { Counts { miss: none } },
        hitgroups: { Cell on Custom => { Counts { intersection: twice, anyhit: each, closesthit: nearest } } },
    }
}
