// G033: a hit borrows nothing: local memory is gone when a program reads its attributes

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Attributes)]
pub struct Found {
    pub normal: &'static Vec3,
}

fn main() {}
