// H034, G012: a program traces only ray types of its pipeline

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
}

#[raygen]
pub fn camera<P: Pipeline>(rg: &RayGen<P>) {
    rg.trace::<Radiance>(
        Traversable::NULL,
        Ray::new(Vec3::ZERO, Vec3::X),
        RadianceFromCaller { rng: Pcg32::new(1, 2) },
    );
}

fn main() {}
