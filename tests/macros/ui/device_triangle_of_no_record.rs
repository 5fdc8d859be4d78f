// G058: a triangle is found by its record and its number

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub bulb: TriangleVertices,
}

#[raygen]
pub fn camera<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
    let [_, _, _] = rg.params().bulb().get(rg, 7);
}

fn main() {}
