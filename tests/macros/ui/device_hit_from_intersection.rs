// G005: an intersection program has no hit yet

use optix_device_rs::prelude::*;

#[intersection]
pub fn program<P: Pipeline>(at: &Intersection<P, Triangles>) {
    let _ = at.attributes();
    let _ = at.hit_kind();
    let _ = at.barycentrics();
    let _ = at.face();
    let _ = at.vertices();
}

fn main() {}
