use optix_device_rs::prelude::*;

#[closesthit]
pub struct Shade;

fn main() {}
