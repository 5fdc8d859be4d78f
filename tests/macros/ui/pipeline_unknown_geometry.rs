// C050, T01: a kind of geometry that there is

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert on Triangle => { Radiance { closesthit: lambert }, Shadow {} } },
    }
}

fn main() {}
