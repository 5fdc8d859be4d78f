// D017, G012, H034: a program traces only ray types of its pipeline

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
