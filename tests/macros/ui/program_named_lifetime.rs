use optix_device_rs::prelude::*;

#[closesthit]
pub fn shade<'a, P: Pipeline>(_: &'a ClosestHit<P, Triangles>) {}

fn main() {}
