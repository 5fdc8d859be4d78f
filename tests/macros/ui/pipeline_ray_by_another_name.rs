// T02, T03: a ray type has one name in a pipeline

mod common;
use common::*;

type Glow = Radiance;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Glow { miss: sky } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert } } },
    }
}

fn main() {}
