// H001: what travels in words can be copied

use optix_device_rs::prelude::*;

#[derive(Words)]
pub struct Spectrum {
    pub bands: [f32; 4],
}

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Spectrum,
}

#[miss]
pub fn dark<P: Pipeline>(_: &Miss<P>) -> RadianceFromMiss {
    RadianceFromMiss { light: Spectrum { bands: [0.0; 4] } }
}

fn main() {}
