use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
}

#[anyhit]
pub fn alpha<P: HasRay<Radiance>>(hit: &AnyHit<P, Triangles>) -> Decision {
    hit.trace::<Radiance>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), RadianceFromCaller { rng: Pcg32::new(1, 2) });
    Decision::Accept
}

fn main() {}
