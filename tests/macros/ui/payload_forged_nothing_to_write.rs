// H024, H022: only the derive says that a party has nothing to write

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
}

impl optix_device_rs::payload::NothingToWrite for RadianceFromMiss {}

fn main() {}
