// I021: what programs throw is an enum

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, UserException)]
pub struct Fault {
    pub pixel: UVec2,
}

fn main() {}
