// I021, I024: each exception has a code of its own

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    Lost = 7,
    Found = 7,
}

fn main() {}
