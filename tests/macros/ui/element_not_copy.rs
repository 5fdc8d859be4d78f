// D004, T02: an element is copied to the device

use optix_device_rs::prelude::*;

#[derive(Element)]
#[repr(C)]
pub struct Vertex {
    pub position: Vec3,
}

#[launch_params]
pub struct Frame {
    pub vertices: Slice<Vertex>,
}

#[raygen]
pub fn camera<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
    let _ = rg.params().vertices().get(0).position;
}

fn main() {}
