// C050, T01: a material is on a kind of geometry

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert => { Radiance { closesthit: lambert }, Shadow {} } },
    }
}

fn main() {}
