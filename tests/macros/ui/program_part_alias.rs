// T03, H022: an alias hides whose part it is

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
}

type Ray = RadianceAtClosestHit;

#[closesthit]
pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, ray: Ray) -> RadianceFromClosestHit {
    RadianceFromClosestHit { light: Vec3::ONE, rng: ray.rng }
}

fn main() {}
