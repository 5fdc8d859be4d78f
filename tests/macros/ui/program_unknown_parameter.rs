// T06: a program's parameters follow from its pipeline

use optix_device_rs::prelude::*;

#[closesthit]
pub fn shade<P: Pipeline, T: Default>(_: &ClosestHit<P, Triangles>) {
    let _ = T::default();
}

fn main() {}
