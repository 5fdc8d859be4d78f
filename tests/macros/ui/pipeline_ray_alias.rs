// D024, H034, T03: two names of one payload are one ray type

mod common;
use common::*;

type Glow = Radiance;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Glow { miss: sky } },
    }
}

fn main() {}
