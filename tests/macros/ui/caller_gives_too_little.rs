// H023, H030, H040: the caller gives every field it must

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
}

#[raygen]
pub fn camera<P: HasRay<Radiance>>(rg: &RayGen<P>) {
    let _ = rg.trace::<Radiance>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), RadianceFromCaller {});
}

fn main() {}
