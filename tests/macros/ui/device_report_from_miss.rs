// G005, G029: a miss program reports no hits

use optix_device_rs::prelude::*;

#[miss]
pub fn program<P: Pipeline>(at: &Miss<P>) {
    let _ = at.report(1.0, 0, Triangles { u: 0.0, v: 0.0 });
}

fn main() {}
