// I021: user codes begin at 0

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    Lost = -1,
}

fn main() {}
