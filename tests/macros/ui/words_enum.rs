// H001, T01: a value in registers is a struct

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Words)]
pub enum Side {
    Left,
    Right,
}

fn main() {}
