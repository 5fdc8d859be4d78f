// G005: a helper says with its context where it may be called

use optix_device_rs::prelude::*;

fn side<P, A>(isect: &Intersection<P, A>) -> bool {
    isect.object_ray_direction().x > 0.0
}

#[miss]
pub fn sky<P: Pipeline>(ms: &Miss<P>) {
    let _ = side(ms);
}

fn main() {}
