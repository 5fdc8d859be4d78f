// G005, H007: rays are traced from ray-generation, closest-hit and miss programs

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Shadow {
    #[payload(write(caller, miss), read(caller))]
    pub visible: bool,
}

#[intersection]
pub fn program<P: HasRay<Shadow>>(at: &Intersection<P, Triangles>) {
    let _ = at.trace::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false });
}

fn main() {}
