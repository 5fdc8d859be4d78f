//! Declarations and a small library of programs for the cases about pipelines.
#![allow(dead_code, unused_imports)]

pub use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub film: SliceMut2d<Vec4>,
    pub world: Traversable,
}

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
}

#[derive(Payload)]
pub struct Shadow {
    #[payload(write(caller, miss), read(caller))]
    pub visible: bool,
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Lambert {
    pub albedo: Vec3,
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Ball {
    pub sphere: Vec4,
}

#[derive(Clone, Copy, Attributes)]
pub struct BallHit {
    pub normal: Vec3,
}

#[derive(Clone, Copy, Attributes)]
pub struct BoxHit {
    pub face: u32,
}

#[raygen]
pub fn camera<P: HasRay<Radiance> + Pipeline<Params = Frame>>(rg: &RayGen<P>) {
    let hit = rg.trace::<Radiance>(rg.params().world(), Ray::new(Vec3::ZERO, Vec3::X), ());
    rg.params().film().set(rg.launch_index().xy(), hit.light.extend(1.0));
}

#[closesthit]
pub fn lambert<P: Pipeline>(_: &ClosestHit<P, Triangles>, record: &Lambert) -> RadianceFromClosestHit {
    RadianceFromClosestHit { light: record.albedo }
}

#[anyhit]
pub fn all<P: Pipeline, A: Attributes>(_: &AnyHit<P, A>) -> Decision {
    Decision::Accept
}

#[closesthit]
pub fn ball_shade<P: Pipeline>(hit: &ClosestHit<P, BallHit>, _: &Ball) -> RadianceFromClosestHit {
    RadianceFromClosestHit { light: hit.attributes().normal }
}

#[intersection]
pub fn ball<P: Pipeline>(isect: &Intersection<P, BallHit>, _: &Ball) {
    isect.report(1.0, 0, BallHit { normal: Vec3::X });
}

#[intersection]
pub fn cube<P: Pipeline>(isect: &Intersection<P, BoxHit>, _: &Ball) {
    isect.report(1.0, 0, BoxHit { face: 3 });
}

#[miss]
pub fn sky<P: Pipeline>(_: &Miss<P>) -> RadianceFromMiss {
    RadianceFromMiss { light: Vec3::ONE }
}

#[miss]
pub fn lit<P: Pipeline>(_: &Miss<P>) -> ShadowFromMiss {
    ShadowFromMiss { visible: true }
}
