// H024: any-hit programs do not run for every ray that hits

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(anyhit), read(closesthit))]
    pub nearest: u32,
}

fn main() {}
