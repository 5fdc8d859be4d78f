// D027: a hit group says what happens to every ray type

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: {
            Lambert on Triangles => { Radiance { closesthit: lambert } },
            Ball on Custom => { Radiance { intersection: ball, closesthit: ball_shade } },
        },
    }
}

fn main() {}
