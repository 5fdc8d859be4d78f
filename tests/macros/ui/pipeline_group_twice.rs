// T07, D027: a material has one hit group

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: {
            Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} },
            Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} },
        },
    }
}

fn main() {}
