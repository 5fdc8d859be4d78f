// G005, G029: a closest-hit program reports no hits

use optix_device_rs::prelude::*;

#[closesthit]
pub fn program<P: Pipeline>(at: &ClosestHit<P, Triangles>) {
    let _ = at.report(1.0, 0, Triangles { u: 0.0, v: 0.0 });
}

fn main() {}
