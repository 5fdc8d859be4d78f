// T06: a context is borrowed for the call

use optix_device_rs::prelude::*;

#[raygen]
pub fn camera<P: Pipeline>(rg: RayGen<P>) {
    let _ = rg;
}

fn main() {}
