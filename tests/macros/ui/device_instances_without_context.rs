// G072, G005: instances are read by a program, with its context

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub lamps: Instances,
}

#[raygen]
pub fn camera<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
    let _ = rg.params().lamps().get(&rg.params(), 0).id();
}

fn main() {}
