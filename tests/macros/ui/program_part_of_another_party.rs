// H022: a program receives its own part of the payload

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
}

#[closesthit]
pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, ray: RadianceFromMiss) -> RadianceFromClosestHit {
    RadianceFromClosestHit { light: ray.light, rng: Pcg32::new(1, 2) }
}

fn main() {}
