// H022: a program receives its part of the payload, not all of it

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
}

#[closesthit]
pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, ray: Radiance) {
    let _ = ray;
}

fn main() {}
