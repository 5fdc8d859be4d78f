// T03: macros find the toolkit under the name that the crate has for it

use optix_device_rs::prelude::*;

#[launch_params(crate = optix_device_rs)]
pub struct Frame {
    pub film: SliceMut2d<Vec4>,
}

#[raygen(crate = optix_device_rs)]
fn camera(_: &RayGen<Flat>) {}

pipeline! {
    pub struct Flat {
        crate: optix_device_rs,
        params: Frame,
        raygen: [camera],
    }
}

fn main() {}
