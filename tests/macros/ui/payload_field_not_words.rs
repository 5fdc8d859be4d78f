// H001: a payload is made of 32-bit words

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub name: &'static str,
}

fn main() {}
