// H001: a struct inside a payload has an encoding of its own

use optix_device_rs::prelude::*;

#[derive(Clone, Copy)]
pub struct Spectrum {
    pub bands: [f32; 4],
}

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: [Spectrum; 2],
}

fn main() {}
