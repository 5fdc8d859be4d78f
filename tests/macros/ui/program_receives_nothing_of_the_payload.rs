// H022, H040: who reads no field of a payload receives nothing of it

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
}

#[closesthit]
pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
    RadianceFromClosestHit { light: 0.5 * ray.light }
}

fn main() {}
