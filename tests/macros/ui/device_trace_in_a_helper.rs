// G005: what a program may not call, its helpers may not either

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Shadow {
    #[payload(write(caller, miss), read(caller))]
    pub visible: bool,
}

fn occluded<P: HasRay<Shadow>, A>(hit: &AnyHit<P, A>) -> bool {
    !hit.trace::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false }).visible
}

#[anyhit]
pub fn program<P: HasRay<Shadow>>(hit: &AnyHit<P, Triangles>) -> Decision {
    if occluded(hit) { Decision::Ignore } else { Decision::Accept }
}

fn main() {}
