// C035, T07: a program of one pipeline is no program of another

mod common;
use common::*;

#[raygen]
pub fn fixed(_: &RayGen<Other>) {}

pipeline! {
    pub struct Other { params: Frame, raygen: [fixed] }
}

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [fixed],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
    }
}

fn main() {}
