// H001, H040: a payload has 32 words at most

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(caller), read(closesthit))]
    pub matrix: [f32; 30],
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
}

fn main() {}
