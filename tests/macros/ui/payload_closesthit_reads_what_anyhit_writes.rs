use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(anyhit), read(closesthit))]
    pub nearest: u32,
}

fn main() {}
