// C034, C035: launch parameters are a struct with #[launch_params]

mod common;
use common::*;

#[raygen]
pub fn noise<P: Pipeline>(_: &RayGen<P>) {}

pipeline! {
    pub struct PathTracer {
        params: Lambert,
        raygen: [noise],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
    }
}

fn main() {}
