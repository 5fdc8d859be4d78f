// T06: a context lasts for the call

use optix_device_rs::prelude::*;

fn keep<P: Pipeline>(hit: &ClosestHit<P, Triangles>) -> &'static ClosestHit<P, Triangles> {
    hit
}

fn main() {}
