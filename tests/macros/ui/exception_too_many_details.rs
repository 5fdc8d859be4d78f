// I022: an exception has 8 words of details at most

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    Lost,
    At { rows: [Vec3; 3] },
}

fn main() {}
