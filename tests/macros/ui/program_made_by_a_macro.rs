// T03, H022: a program out of a macro is checked like any other

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Radiance {
    #[payload(write(closesthit, miss), read(caller))]
    pub light: Vec3,
    #[payload(write(caller, closesthit), read(closesthit, caller))]
    pub rng: Pcg32,
}

macro_rules! shade {
    ($name:ident($part:ty)) => {
        #[closesthit]
        pub fn $name<P: Pipeline>(_: &ClosestHit<P, Triangles>, ray: $part) -> RadianceFromClosestHit {
            let _ = ray;
            RadianceFromClosestHit { light: Vec3::ONE, rng: Pcg32::new(1, 2) }
        }
    };
}
shade!(lambert(RadianceFromMiss));

fn main() {}
