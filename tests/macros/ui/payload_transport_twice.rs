// H004: a payload travels in one way

use optix_device_rs::prelude::*;

#[derive(Payload)]
#[payload(transport = registers, transport = pointer)]
pub struct Path {
    #[payload(write(caller), read(closesthit))]
    pub seed: u32,
}

fn main() {}
