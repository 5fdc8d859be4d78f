// T02: a ray type is named by its payload, which is there

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiancee { miss: sky } },
        hitgroups: { Lambert on Triangles => { Radiancee { closesthit: lambert } } },
    }
}

fn main() {}
