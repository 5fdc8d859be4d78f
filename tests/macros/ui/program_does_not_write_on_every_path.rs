// H024: a program writes its fields on every path

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
}

#[closesthit]
pub fn shade<P: Pipeline>(hit: &ClosestHit<P, Triangles>, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
    if hit.primitive_index() == 0 {
        RadianceFromClosestHit { light: Vec3::ONE, rng: ray.rng }
    }
}

fn main() {}
