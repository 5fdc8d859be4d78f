// H024: adding to a field nobody wrote

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
}

#[miss]
pub fn sky<P: Pipeline>(ms: &Miss<P>) -> RadianceFromMiss {
    let mut out: RadianceFromMiss;
    out.light += ms.world_ray_direction();
    out
}

fn main() {}
