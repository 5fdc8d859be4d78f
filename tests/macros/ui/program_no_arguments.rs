use optix_device_rs::prelude::*;

#[closesthit]
pub fn shade() {}

fn main() {}
