// T01: an attribute takes no arguments it does not know

use optix_device_rs::prelude::*;

#[closesthit(Radiance)]
pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>) {}

fn main() {}
