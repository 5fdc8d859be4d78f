// H033: a program has one payload

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
}

#[derive(Payload)]
pub struct Shadow {
    #[payload(write(closesthit, miss), read(caller))]
    pub visible: bool,
}

#[closesthit]
pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, ray: RadianceAtClosestHit) -> ShadowFromClosestHit {
    let _ = ray;
    ShadowFromClosestHit { visible: false }
}

fn main() {}
