// H024: what the caller reads is written when the ray hits

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(miss), read(caller))]
    pub visible: bool,
}

fn main() {}
