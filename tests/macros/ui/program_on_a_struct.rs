// T06: a program is a function

use optix_device_rs::prelude::*;

#[closesthit]
pub struct Shade;

fn main() {}
