// T02: a material is named by its record, which is there

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky } },
        hitgroups: { Lambret on Triangles => { Radiance { closesthit: lambert } } },
    }
}

fn main() {}
