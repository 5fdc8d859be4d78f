use optix_device_rs::prelude::*;

#[anyhit]
pub fn alpha<P: Pipeline>(_: &AnyHit<P, Triangles>) {}

#[anyhit]
pub fn cutout<P: Pipeline>(_: &AnyHit<P, Triangles>) -> bool {
    true
}

fn main() {}
