// G005, G014: a ray-generation program has no ray

use optix_device_rs::prelude::*;

#[raygen]
pub fn program<P: Pipeline>(at: &RayGen<P>) {
    let _ = at.world_ray_origin();
    let _ = at.world_ray_direction();
    let _ = at.ray_tmin();
    let _ = at.ray_tmax();
    let _ = at.ray_time();
    let _ = at.ray_flags();
    let _ = at.ray_visibility_mask();
}

fn main() {}
