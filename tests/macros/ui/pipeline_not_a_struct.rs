// T01: a pipeline has a name

mod common;
use common::*;

pipeline! {
    params: Frame,
}

fn main() {}
