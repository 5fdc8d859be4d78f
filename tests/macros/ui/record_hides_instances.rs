// T05, D004: an alias does not hide the instances of a structure

use optix_device_rs::prelude::*;

type Lamps = Instances;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Lamp {
    pub lamps: Lamps,
}

fn main() {}
