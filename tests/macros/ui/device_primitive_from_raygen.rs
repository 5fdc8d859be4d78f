// G005: a ray-generation program has no primitive

use optix_device_rs::prelude::*;

#[raygen]
pub fn program<P: Pipeline>(at: &RayGen<P>) {
    let _ = at.primitive_index();
    let _ = at.sbt_gas_index();
    let _ = at.instance_id();
    let _ = at.instance_index();
    let _ = at.object_to_world();
    let _ = at.world_to_object();
}

fn main() {}
