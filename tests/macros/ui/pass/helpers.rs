//! G002, G005: helpers take the context, of one kind or any; what looks like recursion and is none.
#![deny(warnings)]

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Shadow {
    #[payload(write(caller, miss), read(caller))]
    pub visible: bool,
}

fn lit<P: HasRay<Shadow>, A>(hit: &ClosestHit<P, A>) -> bool {
    let away = Ray::new(hit.world_ray_origin(), Vec3::Y);
    hit.trace::<Shadow>(Traversable::NULL, away, ShadowFromCaller { visible: false }).visible
}

mod other {
    pub fn shade(depth: u32) -> u32 {
        if depth == 0 { 0 } else { shade(depth - 1) }
    }
}

trait Shades {
    fn shade(&self) -> u32;
}

impl Shades for u32 {
    fn shade(&self) -> u32 {
        *self
    }
}

#[closesthit]
pub fn shade<P: HasRay<Shadow>>(hit: &ClosestHit<P, Triangles>) {
    let _ = lit(hit);
    let _ = other::shade(hit.primitive_index()).shade();
}

#[closesthit]
pub fn twice<P: Pipeline>(hit: &ClosestHit<P, Triangles>) {
    let twice = |x: u32| 2 * x;
    let _ = twice(hit.primitive_index());
}

/// A program may be called by another, as the function it is.
#[closesthit]
pub fn outer<P: HasRay<Shadow>>(hit: &ClosestHit<P, Triangles>) {
    shade(hit);
    twice(hit);
}

fn main() {}
