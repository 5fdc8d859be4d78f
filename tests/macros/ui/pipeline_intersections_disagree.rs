// C020, H033: the intersection programs of a hit group report the same attributes

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: {
            Ball on Custom => {
                Radiance { intersection: ball, closesthit: ball_shade },
                Shadow { intersection: cube },
            },
        },
    }
}

fn main() {}
