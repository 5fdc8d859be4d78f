// I021: codes that are counted on end at 2^30 - 1, too

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    Last = (1 << 30) - 1,
    Lost,
}

fn main() {}
