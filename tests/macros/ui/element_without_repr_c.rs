// T04: host and device agree on the layout

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Element)]
pub struct Vertex {
    pub position: Vec3,
}

fn main() {}
