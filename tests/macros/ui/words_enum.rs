use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Words)]
pub enum Side {
    Left,
    Right,
}

fn main() {}
