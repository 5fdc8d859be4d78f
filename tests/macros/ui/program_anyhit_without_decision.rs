// G076, H005: an any-hit program says what happens to the hit

use optix_device_rs::prelude::*;

#[anyhit]
pub fn alpha<P: Pipeline>(_: &AnyHit<P, Triangles>) {}

#[anyhit]
pub fn cutout<P: Pipeline>(_: &AnyHit<P, Triangles>) -> bool {
    true
}

fn main() {}
