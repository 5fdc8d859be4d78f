// T06: a program's arguments have named types

use optix_device_rs::prelude::*;

#[closesthit]
pub fn shade(_: &ClosestHit<impl Pipeline, Triangles>, record: &impl SbtRecord) {
    let _ = record;
}

fn main() {}
