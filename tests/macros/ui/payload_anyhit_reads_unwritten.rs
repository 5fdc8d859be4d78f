// H024: any-hit programs may run first

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(anyhit, closesthit, miss), read(anyhit, caller))]
    pub count: u32,
}

fn main() {}
