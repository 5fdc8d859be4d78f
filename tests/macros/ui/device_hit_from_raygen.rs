// G005: a ray-generation program has no hit

use optix_device_rs::prelude::*;

#[raygen]
pub fn program<P: Pipeline>(at: &RayGen<P>) {
    let _ = at.attributes();
    let _ = at.hit_kind();
    let _ = at.barycentrics();
    let _ = at.face();
    let _ = at.vertices();
}

fn main() {}
