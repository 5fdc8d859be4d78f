use optix_device_rs::prelude::*;

pub struct Camera;

impl Camera {
    #[raygen]
    pub fn camera(&self) {}
}

fn main() {}
