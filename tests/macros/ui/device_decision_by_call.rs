// G076, H005: an any-hit program returns its decision, so its payload counts

use optix_device_rs::prelude::*;

#[anyhit]
pub fn program<P: Pipeline>(at: &AnyHit<P, Triangles>) -> Decision {
    if at.hit_kind() == HitKind::TRIANGLE_FRONT_FACE {
        at.ignore_intersection();
    }
    at.terminate_ray();
    Decision::Accept
}

fn main() {}
