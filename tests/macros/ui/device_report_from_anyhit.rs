// G005, G029: an any-hit program reports no hits

use optix_device_rs::prelude::*;

#[anyhit]
pub fn program<P: Pipeline>(at: &AnyHit<P, Triangles>) -> Decision {
    let _ = at.report(1.0, 0, Triangles { u: 0.0, v: 0.0 });
    Decision::Accept
}

fn main() {}
