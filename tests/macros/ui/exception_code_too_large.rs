// I021: user codes end at 2^30 - 1

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    Lost = 1 << 30,
}

fn main() {}
