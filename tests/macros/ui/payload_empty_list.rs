// T01: a list names somebody

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(), read(caller))]
    pub light: Vec3,
}

fn main() {}
