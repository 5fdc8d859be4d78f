// G033: a hit borrows nothing

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Attributes)]
pub struct Found<'a> {
    pub normal: &'a Vec3,
}

fn main() {}
