// I022: what programs throw is `Copy`

use optix_device_rs::prelude::*;

#[derive(UserException)]
pub enum Fault {
    Lost,
}

fn main() {}
