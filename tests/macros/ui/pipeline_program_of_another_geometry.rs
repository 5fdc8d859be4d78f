// C020, G054: a program reads the attributes that its hit group reports

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: {
            Ball on Custom => {
                Radiance { intersection: cube, closesthit: ball_shade },
                Shadow { intersection: cube },
            },
        },
    }
}

fn main() {}
