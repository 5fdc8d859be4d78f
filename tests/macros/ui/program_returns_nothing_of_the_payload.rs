// H022, H023: who writes no field of a payload returns nothing of it

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(caller, closesthit), read(caller))]
    pub light: Vec3,
}

#[miss]
pub fn dark<P: Pipeline>(_: &Miss<P>) -> RadianceFromMiss {
    RadianceFromMiss { light: Vec3::ZERO }
}

fn main() {}
