// G005, G014, G040: a ray-generation program has no ray in object space

use optix_device_rs::prelude::*;

#[raygen]
pub fn program<P: Pipeline>(at: &RayGen<P>) {
    let _ = at.object_ray_origin();
    let _ = at.object_ray_direction();
}

fn main() {}
