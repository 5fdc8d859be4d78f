// T03, T06: an alias hides which context it is

use optix_device_rs::prelude::*;

type Hit<'a, P> = &'a ClosestHit<P, Triangles>;

#[closesthit]
pub fn shade<P: Pipeline>(_: Hit<P>) {}

fn main() {}
