// D009: a record of any type is still a record

use optix_device_rs::prelude::*;

#[closesthit]
pub fn shade<P: Pipeline, R>(_: &ClosestHit<P, Triangles>, record: &R) {
    let _ = record;
}

fn main() {}
