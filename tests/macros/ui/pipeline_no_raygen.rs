// D012: a launch begins with a ray-generation program

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
    }
}

fn main() {}
