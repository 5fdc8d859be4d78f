// T02, H017, H024: all mistakes of a payload are reported at once

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit), read(caller))]
    pub light: Vec3,
    #[payload(write(closesthit, miss))]
    pub seed: u32,
    pub depth: u32,
}

fn main() {}
