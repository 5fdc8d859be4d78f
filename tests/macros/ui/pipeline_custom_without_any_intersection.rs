// C050: custom primitives have an intersection program

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Ball on Custom => { Radiance { closesthit: ball_shade }, Shadow {} } },
    }
}

fn main() {}
