mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Shadow { miss: lit } },
    }
}

fn main() {}
