// T01: programs read launch parameters by methods

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub count: u32,
}

#[raygen]
pub fn camera<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
    let _ = rg.params().count;
}

fn main() {}
