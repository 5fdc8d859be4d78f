// G023: a ray culls front faces or back faces

use optix_device_rs::prelude::*;

pub fn flags() -> RayFlags {
    RayFlags::NONE.cull(CullFaces::Front | CullFaces::Back)
}

fn main() {}
