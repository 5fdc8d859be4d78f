// T07: a pipeline is one set of programs

mod common;
use common::*;

pipeline! {
    pub struct PathTracer<T> {
        params: Frame,
    }
}

fn main() {}
