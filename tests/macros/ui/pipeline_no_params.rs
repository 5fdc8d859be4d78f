// C034: a pipeline has launch parameters

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
    }
}

fn main() {}
