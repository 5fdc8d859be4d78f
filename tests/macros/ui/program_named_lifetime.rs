// T06: context and record are borrowed for the call

use optix_device_rs::prelude::*;

#[closesthit]
pub fn shade<'a, P: Pipeline>(_: &'a ClosestHit<P, Triangles>) {}

fn main() {}
