// G033: a hit carries no address

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Attributes)]
pub struct Found {
    pub normal: *const Vec3,
}

fn main() {}
