// T07: a context is of a pipeline

use optix_device_rs::prelude::*;

#[closesthit]
pub fn shade<P>(_: &ClosestHit<P, Triangles>) {}

fn main() {}
