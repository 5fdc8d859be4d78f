// D009: a record's type is known

use optix_device_rs::prelude::*;

#[closesthit]
pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, record: &dyn SbtRecord) {
    let _ = record;
}

fn main() {}
