// T01: a program has a name

mod common;
use common::*;

pipeline! {
    pub struct PathTracer { params: Frame, raygen: [fn], rays: { Radiance { miss: sky } } }
}

fn main() {}
