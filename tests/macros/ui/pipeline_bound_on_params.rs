// C035: a program sees the launch parameters of its pipeline

mod common;
use common::*;

#[launch_params]
pub struct Other {
    pub count: u32,
}

#[raygen]
pub fn count<P: Pipeline<Params = Other>>(rg: &RayGen<P>) {
    let _ = rg.params().count();
}

pipeline! {
    pub struct PathTracer { params: Frame, raygen: [count], rays: { Radiance { miss: sky } } }
}

fn main() {}
