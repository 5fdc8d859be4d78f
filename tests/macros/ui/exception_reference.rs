// I022: details are values

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    At(&'static str),
}

fn main() {}
