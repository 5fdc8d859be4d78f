// H024: a program writes what its payload says

mod common;
use common::*;

#[closesthit]
pub fn nothing<P: Pipeline>(_: &ClosestHit<P, Triangles>) {}

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: nothing }, Shadow {} } },
    }
}

fn main() {}
