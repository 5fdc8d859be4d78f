mod common;
use common::*;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { A {}, B {}, C {}, D {}, E {}, F {}, G {}, H {}, I {} },
    }
}

fn main() {}
