// G016, G017, G018, G019, G020: the any-hit flags of a ray exclude each other

use optix_device_rs::prelude::*;

pub fn flags() -> RayFlags {
    RayFlags::NONE.any_hit(AnyHitMode::Disable | AnyHitMode::Enforce)
}

fn main() {}
