// C037: programs read launch parameters and do not set them

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub count: u32,
    pub counts: SliceMut<u32>,
}

#[raygen]
pub fn camera<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
    rg.params().count = 3;
}

fn main() {}
