// G016, G020, G023: flags that exclude each other are not put together

use optix_device_rs::prelude::*;

pub fn flags() -> RayFlags {
    RayFlags::from_bits(1 | 2 | 16 | 32)
}

fn main() {}
