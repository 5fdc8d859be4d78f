// T06: a program takes context, record and payload

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Lambert {
    pub albedo: Vec3,
}

#[miss]
pub fn sky<P: Pipeline>(_: &Miss<P>, _: &Lambert, _: RadianceAtMiss, _: u32) -> RadianceFromMiss {
    todo!()
}

fn main() {}
