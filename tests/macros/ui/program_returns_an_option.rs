// H024: a program writes its payload on every path

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
}

#[closesthit]
pub fn shade<P: Pipeline>(hit: &ClosestHit<P, Triangles>, ray: RadianceAtClosestHit) -> Option<RadianceFromClosestHit> {
    (hit.primitive_index() == 0).then(|| RadianceFromClosestHit { light: Vec3::ONE, rng: ray.rng })
}

fn main() {}
