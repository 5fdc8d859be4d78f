// I008, I009: what a direct callable calls traces no rays either

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Shadow {
    #[payload(write(caller, miss), read(caller))]
    pub visible: bool,
}

fn visible<P: HasRay<Shadow>>(cc: &ContinuationCallable<P>) -> bool {
    cc.trace::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false }).visible
}

#[direct_callable]
pub fn program<P: HasRay<Shadow>>(dc: &DirectCallable<P>) -> f32 {
    if visible(dc) { 1.0 } else { 0.0 }
}

fn main() {}
