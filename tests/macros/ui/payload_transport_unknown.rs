// H004: a payload travels in registers or by a pointer

use optix_device_rs::prelude::*;

#[derive(Payload)]
#[payload(transport = memory)]
pub struct Path {
    #[payload(write(caller), read(closesthit))]
    pub matrix: [f32; 40],
}

fn main() {}
