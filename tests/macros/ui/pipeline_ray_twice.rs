// D024, H034: a ray type is there once

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit }, Radiance { miss: sky } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
    }
}

fn main() {}
