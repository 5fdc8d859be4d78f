// T01: a ray type is one type, without bounds

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance + Send { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
    }
}

fn main() {}
