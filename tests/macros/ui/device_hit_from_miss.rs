// G005: a miss program has no hit

use optix_device_rs::prelude::*;

#[miss]
pub fn program<P: Pipeline>(at: &Miss<P>) {
    let _ = at.attributes();
    let _ = at.hit_kind();
    let _ = at.barycentrics();
    let _ = at.face();
    let _ = at.vertices();
}

fn main() {}
