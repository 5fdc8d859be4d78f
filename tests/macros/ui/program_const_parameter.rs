// T06: a program's parameters follow from its pipeline

use optix_device_rs::prelude::*;

#[raygen]
pub fn camera<P: Pipeline, const SAMPLES: usize>(_: &RayGen<P>) {
    let _ = SAMPLES;
}

fn main() {}
