// G072, G073: only a structure that is built for it has instances to read

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub world: Traversable,
    pub lamps: Instances,
}

#[raygen]
pub fn camera<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
    let _ = rg.params().world().get(rg, 0).id();
}

fn main() {}
