// H001, H004: an address has no encoding in words

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Path {
    #[payload(write(caller), read(closesthit))]
    pub seed: &'static u32,
    #[payload(write(caller), read(closesthit))]
    pub raw: *const u32,
}

fn main() {}
