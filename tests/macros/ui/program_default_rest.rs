// H024: no field is written by default

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
}

#[closesthit]
pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>) -> RadianceFromClosestHit {
    RadianceFromClosestHit { light: Vec3::ONE, ..Default::default() }
}

fn main() {}
