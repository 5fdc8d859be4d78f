// H017: who reads and writes is said of each field

use optix_device_rs::prelude::*;

#[derive(Payload)]
#[payload(write(caller), read(closesthit))]
pub struct Path {
    #[payload(write(caller), read(closesthit))]
    pub seed: u32,
}

fn main() {}
