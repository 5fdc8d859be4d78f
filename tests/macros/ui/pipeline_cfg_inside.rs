// T01: cfg above the macro holds for all it makes

mod common;
use common::*;

pipeline! {
    #[cfg(debug_assertions)]
    pub struct PathTracer { params: Frame, raygen: [camera], rays: { Radiance { miss: sky } } }
}

fn main() {}
