// G005, G040: a miss program has no ray in object space

use optix_device_rs::prelude::*;

#[miss]
pub fn program<P: Pipeline>(at: &Miss<P>) {
    let _ = at.object_ray_origin();
    let _ = at.object_ray_direction();
}

fn main() {}
