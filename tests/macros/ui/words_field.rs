// H001: a value in registers has an encoding in 32-bit words

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Words)]
pub struct Path {
    pub length: usize,
}

fn main() {}
