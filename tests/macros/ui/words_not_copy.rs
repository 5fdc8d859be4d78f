// H001: a value in registers is copied

use optix_device_rs::prelude::*;

#[derive(Words)]
pub struct Id(pub u32);

fn main() {}
