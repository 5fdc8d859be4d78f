// H024: what the caller reads is written when the ray misses

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit), read(caller))]
    pub light: Vec3,
}

fn main() {}
