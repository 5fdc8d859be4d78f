//! Cases of commonest mistakes, put right: one module each, with the name of the case.
#![allow(dead_code, unused)]

mod program_receives_nothing_of_the_payload {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(caller, closesthit), read(caller, closesthit))]
        pub light: Vec3,
    }

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: 0.5 * ray.light }
    }
}

mod program_returns_nothing_of_the_payload {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
    }

    #[miss]
    pub fn dark<P: Pipeline>(_: &Miss<P>) -> RadianceFromMiss {
        RadianceFromMiss { light: Vec3::ZERO }
    }
}

mod payload_field_not_copy {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Debug, Words)]
    pub struct Spectrum {
        pub bands: [f32; 4],
    }

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Spectrum,
    }

    #[miss]
    pub fn dark<P: Pipeline>(_: &Miss<P>) -> RadianceFromMiss {
        RadianceFromMiss { light: Spectrum { bands: [0.0; 4] } }
    }
}

fn main() {}
