mod common;
use common::*;

pipeline! {
    params: Frame,
}

fn main() {}
