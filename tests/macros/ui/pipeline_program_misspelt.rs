// C013: a program is there

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: skye } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert } } },
    }
}

fn main() {}
