// T06: a program takes its context

use optix_device_rs::prelude::*;

#[closesthit]
pub fn shade() {}

fn main() {}
