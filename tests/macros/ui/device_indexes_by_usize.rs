// T01: an index of a view is a `u32`

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub counts: SliceMut<u32>,
}

#[raygen]
pub fn camera<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
    let i: usize = 4;
    rg.params().counts().set(i, 4);
}

fn main() {}
