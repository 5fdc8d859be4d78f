// H024: any-hit programs do not run for every ray

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(anyhit), read(caller))]
    pub count: u32,
}

fn main() {}
