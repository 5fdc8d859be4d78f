// G056, G058: the GAS of a hit says nothing of its other triangles

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub bulb: TriangleVertices,
}

#[closesthit]
pub fn shade<P: Pipeline<Params = Frame>>(hit: &ClosestHit<P, Triangles>) {
    let _ = hit.gas_handle().get(hit, hit.sbt_gas_index(), hit.primitive_index() + 1);
}

fn main() {}
