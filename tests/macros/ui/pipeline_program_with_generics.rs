// T01: a program is named without its types

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert::<PathTracer> }, Shadow {} } },
    }
}

fn main() {}
