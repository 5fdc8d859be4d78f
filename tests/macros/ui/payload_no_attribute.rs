// H017: every field says who reads and writes it

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    pub light: Vec3,
    #[payload(write(caller), read(miss))]
    pub seed: u32,
}

fn main() {}
