// H040: what the last program of a ray writes, the caller reads

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(caller, closesthit), read(closesthit))]
    pub throughput: Vec3,
}

fn main() {}
