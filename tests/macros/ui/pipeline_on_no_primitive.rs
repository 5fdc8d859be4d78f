// C050, T01: what stands after `on` is a kind of primitive

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert on Ball => { Radiance { closesthit: lambert }, Shadow {} } },
    }
}

fn main() {}
