// H007, H040: a ray-generation program has no payload

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
}

#[raygen]
pub fn camera<P: Pipeline>(_: &RayGen<P>, ray: RadianceAtCaller) {
    let _ = ray;
}

#[raygen]
pub fn lens<P: Pipeline>(_: &RayGen<P>) -> Vec3 {
    Vec3::ONE
}

fn main() {}
