// T01: elements of a view are not named by brackets

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub film: SliceMut2d<Vec4>,
    pub counts: SliceMut<u32>,
    pub normals: Slice<Vec3>,
}

#[raygen]
pub fn camera<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
    let i = rg.launch_index().x;
    rg.params().counts()[i] = 4;
    let _ = rg.params().normals()[i as usize];
    let _ = rg.params().film()[rg.launch_index().xy()];
}

fn main() {}
