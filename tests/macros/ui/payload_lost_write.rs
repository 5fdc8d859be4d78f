use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(caller, closesthit), read(closesthit))]
    pub throughput: Vec3,
}

fn main() {}
