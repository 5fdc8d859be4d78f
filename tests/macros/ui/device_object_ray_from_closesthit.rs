// G005, G040: a closest-hit program has no ray in object space

use optix_device_rs::prelude::*;

#[closesthit]
pub fn program<P: Pipeline>(at: &ClosestHit<P, Triangles>) {
    let _ = at.object_ray_origin();
    let _ = at.object_ray_direction();
}

fn main() {}
