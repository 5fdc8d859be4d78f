// T06: a context is of a pipeline

use optix_device_rs::prelude::*;

#[raygen]
pub fn camera(rg: &RayGen) {}

#[closesthit]
pub fn shade<P: Pipeline>(hit: &ClosestHit<P>) {}

fn main() {}
