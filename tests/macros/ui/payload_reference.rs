// H001, H004: a payload borrows nothing

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Path {
    #[payload(write(caller), read(closesthit))]
    pub seed: &'static u32,
}

fn main() {}
