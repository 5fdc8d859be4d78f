// H004: all fields of a payload travel in one way

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Path {
    #[payload(write(caller), read(closesthit), transport = pointer)]
    pub matrix: [f32; 40],
}

fn main() {}
