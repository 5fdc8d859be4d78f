// I022: details travel in registers

use optix_device_rs::prelude::*;

#[derive(Clone, Copy)]
pub struct Place {
    pub at: Vec3,
}

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    At(Place),
}

fn main() {}
