// T02: a payload has its derive

mod common;
use common::Frame;
use optix_device_rs::prelude::*;

pub struct Glow {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
}

#[raygen]
pub fn look(rg: &RayGen<PathTracer>) {
    let _ = rg.trace::<Glow>(rg.params().world(), Ray::new(Vec3::ZERO, Vec3::X), ());
}

#[miss]
pub fn dusk(_: &Miss<PathTracer>) -> GlowFromMiss {
    GlowFromMiss { light: Vec3::ONE }
}

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [look],
        rays: { Glow { miss: dusk } },
    }
}

fn main() {}
