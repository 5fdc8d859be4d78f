// T02, H024: one mistake in a payload is one error

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit), read(caller))]
    pub light: Vec3,
}

#[closesthit]
pub fn white<P: Pipeline>(_: &ClosestHit<P, Triangles>) -> RadianceFromClosestHit {
    RadianceFromClosestHit { light: Vec3::ONE }
}

#[raygen]
pub fn camera<P: HasRay<Radiance>>(rg: &RayGen<P>) {
    let _ = rg.trace::<Radiance>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ()).light;
}

fn main() {}
