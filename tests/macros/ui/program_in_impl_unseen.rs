// T06: a program is a free function

use optix_device_rs::prelude::*;

pub struct Camera;

impl Camera {
    #[raygen]
    pub fn camera<P: Pipeline>(_: &RayGen<P>) {}
}

fn main() {}
