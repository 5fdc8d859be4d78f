// T01: an option that there is

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Words)]
#[optix(krate = optix_device_rs)]
pub struct Id(pub u32);

fn main() {}
