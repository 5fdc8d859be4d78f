use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(read(caller))]
    pub light: Vec3,
}

fn main() {}
