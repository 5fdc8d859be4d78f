// T05: a buffer holds no view of a structure

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Element)]
#[repr(C)]
pub struct Lamp {
    pub lamps: Instances,
}

fn main() {}
