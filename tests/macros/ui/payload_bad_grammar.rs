// T01: parties stand in brackets

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write = caller, read(caller))]
    pub light: Vec3,
    #[payload(wirte(caller), read(caller))]
    pub seed: u32,
}

fn main() {}
