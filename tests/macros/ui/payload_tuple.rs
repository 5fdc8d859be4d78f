// H012: a payload's fields have names

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance(Vec3);

fn main() {}
