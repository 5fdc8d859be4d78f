// C049, H024: a closest-hit program may be left out where the payload asks nothing of it

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert on Triangles => { Radiance { anyhit: all }, Shadow {} } },
    }
}

fn main() {}
