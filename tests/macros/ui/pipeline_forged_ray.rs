// G012, D024, T07: only pipeline! says which ray types a pipeline has

mod common;
use common::*;

pipeline! {
    pub struct PathTracer { params: Frame, raygen: [camera], rays: { Radiance { miss: sky } } }
}

impl HasRay<Shadow> for PathTracer {
    const INDEX: u32 = 99;
    type MissRecord = ();
}

fn main() {}
