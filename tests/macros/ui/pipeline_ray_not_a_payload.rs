// H012, H034: a ray type is named by its payload

mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Lambert {} },
    }
}

fn main() {}
