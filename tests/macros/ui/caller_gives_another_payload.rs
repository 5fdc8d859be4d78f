// H029, H030: the caller gives the payload of the ray type it traces

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
    let start = ShadowFromCaller { visible: false };
    let _ = rg.trace::<Radiance>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), start);
}

fn main() {}
