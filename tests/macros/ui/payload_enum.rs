// H012: a payload is a struct of fields

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub enum Radiance {
    Black,
    Light(f32),
}

fn main() {}
