// T02, T06: who may name a pipeline may name its launch parameters

mod common;
use common::{Radiance, sky};
use optix_device_rs::prelude::*;

#[launch_params]
struct Frame {
    count: u32,
}

#[raygen]
fn camera(rg: &RayGen<PathTracer>) {
    let _ = rg.params().count();
}

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky } },
    }
}

fn main() {}
