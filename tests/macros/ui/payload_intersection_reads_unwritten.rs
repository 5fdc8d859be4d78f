// H024: intersection programs may run first

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(intersection), read(intersection))]
    pub count: u32,
}

fn main() {}
