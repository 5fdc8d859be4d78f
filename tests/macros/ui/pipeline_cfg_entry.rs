// T07, T01: a pipeline is the same on host and device

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, #[cfg(debug_assertions)] Shadow { miss: lit } },
        hitgroups: {
            Lambert on Triangles => { Radiance { closesthit: lambert, #[cfg(debug_assertions)] anyhit: all } },
        },
    }
}

fn main() {}
