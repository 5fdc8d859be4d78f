mod common;
use common::*;

pipeline! {
    pub struct PathTracer<T> {
        params: Frame,
    }
}

fn main() {}
