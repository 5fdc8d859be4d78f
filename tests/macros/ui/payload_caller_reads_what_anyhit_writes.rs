use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(anyhit), read(caller))]
    pub count: u32,
}

fn main() {}
