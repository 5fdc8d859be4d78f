// T03: a payload's parts have its name

use optix_device_rs::prelude::*;

pub struct RadianceFromMiss;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
}

fn main() {}
