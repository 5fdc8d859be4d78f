// H029: a trace call names its ray type

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
}

#[derive(Payload)]
pub struct Shadow {
    #[payload(write(caller, miss), read(caller))]
    pub visible: bool,
}

#[raygen]
pub fn camera<P: HasRay<Radiance> + HasRay<Shadow>>(rg: &RayGen<P>) {
    let _ = rg.trace(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), Default::default());
}

fn main() {}
