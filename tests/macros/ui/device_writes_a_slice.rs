// T05: what is declared as read is not written

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub table: Slice<u32>,
}

#[raygen]
pub fn camera<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
    rg.params().table().set(0, 3);
}

fn main() {}
