//! Cases of commonest mistakes, put right: one module each, with the name of the case.
#![allow(dead_code, unused)]

#[path = "../common/mod.rs"]
mod common;

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

mod pipeline_programs_without_attributes {
    use crate::common::*;

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, record: &Lambert) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: record.albedo }
    }

    #[raygen]
    pub fn start<P: HasRay<Radiance> + Pipeline<Params = Frame>>(_: &RayGen<P>) {}

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [start],
            rays: { Radiance { miss: sky } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: shade } } },
        }
    }
}

mod pipeline_program_of_another_module {
    use crate::common::*;

    mod sky_model {
        use super::*;

        #[miss]
        pub fn hazy<P: Pipeline>(_: &Miss<P>) -> RadianceFromMiss {
            RadianceFromMiss { light: Vec3::ONE }
        }
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky_model::hazy } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert } } },
        }
    }
}

mod pipeline_program_misspelt {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert } } },
        }
    }
}

mod element_padding_at_the_end {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Element)]
    #[repr(C)]
    pub struct Sample {
        pub weight: f64,
        pub position: Vec3,
        pub pad: [u8; 4],
    }

    #[derive(Clone, Copy, Element)]
    #[repr(C)]
    pub struct Pair(u8, [u8; 1], u16);
}

fn main() {}
