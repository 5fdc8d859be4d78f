// C013: context and attribute are of one kind

use optix_device_rs::prelude::*;

#[closesthit]
pub fn shade<P: Pipeline>(hit: &AnyHit<P, Triangles>) {
    let _ = hit;
}

fn main() {}
