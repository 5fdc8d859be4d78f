// T01: a field says once who reads and writes it

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(caller))]
    #[payload(read(closesthit))]
    pub light: Vec3,
}

fn main() {}
