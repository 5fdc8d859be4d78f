use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Words)]
pub struct Path {
    pub length: usize,
}

fn main() {}
