// I021: what programs throw is not generic

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, UserException)]
pub enum Fault<T> {
    At(T),
}

fn main() {}
