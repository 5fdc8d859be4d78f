// H024: a program writes its payload on every path

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
}

type Result<T> = core::result::Result<T, ()>;

#[miss]
pub fn sky<P: Pipeline>(_: &Miss<P>) -> Result<RadianceFromMiss> {
    Ok(RadianceFromMiss { light: Vec3::ONE })
}

fn main() {}
