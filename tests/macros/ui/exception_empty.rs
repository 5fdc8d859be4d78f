// I021: what programs throw has variants

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, UserException)]
pub enum Fault {}

fn main() {}
