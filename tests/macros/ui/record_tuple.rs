// D008: a record's fields have names

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Lambert(Vec3);

fn main() {}
