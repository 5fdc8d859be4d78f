// T01: a part of a pipeline that there is

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        ray: {},
        hit_groups: {},
        callables: [],
    }
}

fn main() {}
