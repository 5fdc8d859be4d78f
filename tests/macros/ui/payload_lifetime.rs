// H002, H012: a payload borrows nothing

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Path<'a> {
    #[payload(write(caller), read(closesthit))]
    pub seeds: &'a [u32],
}

fn main() {}
