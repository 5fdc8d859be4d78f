// C057, G013: trace calls nest 31 deep at most

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        trace_depth: 32,
    }
}

fn main() {}
