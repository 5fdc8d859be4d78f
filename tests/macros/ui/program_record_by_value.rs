// D008: a record is borrowed

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

#[closesthit]
pub fn shade<P: Pipeline>(
    _: &ClosestHit<P, Triangles>,
    record: Lambert,
    ray: RadianceAtClosestHit,
) -> RadianceFromClosestHit {
    RadianceFromClosestHit { light: record.albedo, rng: ray.rng }
}

fn main() {}
