// G005, G076: only an any-hit program decides about a hit

use optix_device_rs::prelude::*;

#[closesthit]
pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>) -> Decision {
    Decision::Ignore
}

fn main() {}
