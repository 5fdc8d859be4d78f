// H028, H029: a program has one payload

use optix_device_rs::prelude::*;

#[closesthit]
pub fn shade<P: Pipeline, R: Payload>(_: &ClosestHit<P, Triangles>, ray: R::AtClosestHit) {
    let _ = ray;
}

fn main() {}
