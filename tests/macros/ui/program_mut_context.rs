// T06: a context is shared

use optix_device_rs::prelude::*;

#[raygen]
pub fn camera<P: Pipeline>(rg: &mut RayGen<P>) {
    let _ = rg;
}

fn main() {}
