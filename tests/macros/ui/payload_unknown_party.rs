// H017: only parties of a ray read and write

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(raygen, closest_hit), read(wombat))]
    pub light: Vec3,
}

fn main() {}
