// G022, H024: whether closest-hit programs run is known where a ray is traced

use optix_device_rs::prelude::*;

pub fn flags() -> RayFlags {
    RayFlags::NONE.terminate_on_first_hit().disable_closesthit()
}

fn main() {}
