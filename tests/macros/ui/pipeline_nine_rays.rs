// H013, D024, D025: a pipeline has eight ray types at most

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
