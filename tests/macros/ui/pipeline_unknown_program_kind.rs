// C047: a kind of program that hit groups have

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert on Triangles => { Radiance { closest_hit: lambert, exception: lambert }, Shadow {} } },
    }
}

fn main() {}
