// G002: a program is no recursive function

use optix_device_rs::prelude::*;

#[closesthit]
pub fn shade<P: Pipeline>(hit: &ClosestHit<P, Triangles>) {
    if hit.primitive_index() > 0 {
        shade(hit);
    }
}

fn main() {}
