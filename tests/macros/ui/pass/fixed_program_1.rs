//! The cases about programs, put right: one module each, with the name of the case.
#![allow(dead_code, unused)]

#[path = "../common/mod.rs"]
mod common;

mod program_adds_to_what_is_not_written {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }

    #[miss]
    pub fn sky<P: Pipeline>(ms: &Miss<P>) -> RadianceFromMiss {
        let mut out = RadianceFromMiss { light: Vec3::ZERO };
        out.light += ms.world_ray_direction();
        out
    }
}

mod program_adds_to_what_it_may_not_read {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, mut ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
        let _ = ray.rng.next_u32();
        RadianceFromClosestHit { light: Vec3::ONE, rng: ray.rng }
    }
}

mod program_anyhit_without_decision {
    use optix_device_rs::prelude::*;

    #[anyhit]
    pub fn alpha<P: Pipeline>(_: &AnyHit<P, Triangles>) -> Decision {
        Decision::Accept
    }

    #[anyhit]
    pub fn cutout<P: Pipeline>(_: &AnyHit<P, Triangles>) -> Decision {
        Decision::Ignore
    }
}

mod program_calls_itself {
    use optix_device_rs::prelude::*;

    #[closesthit]
    pub fn shade<P: Pipeline>(hit: &ClosestHit<P, Triangles>) {
        if hit.primitive_index() > 0 {
            let _ = hit.barycentrics();
        }
    }
}

mod program_cfg_argument {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Sky {
        pub zenith: Vec3,
    }

    #[miss]
    pub fn sky<P: Pipeline>(_: &Miss<P>, record: &Sky) {
        let _ = record.zenith;
    }
}

mod program_closesthit_decides {
    use optix_device_rs::prelude::*;

    #[anyhit]
    pub fn shade<P: Pipeline>(_: &AnyHit<P, Triangles>) -> Decision {
        Decision::Ignore
    }
}

mod program_const_parameter {
    use optix_device_rs::prelude::*;

    #[raygen]
    pub fn camera<P: Pipeline>(_: &RayGen<P>) {
        const SAMPLES: usize = 4;
        let _ = SAMPLES;
    }
}

mod program_context_alias {
    use optix_device_rs::prelude::*;

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>) {}
}

mod program_context_by_value {
    use optix_device_rs::prelude::*;

    #[raygen]
    pub fn camera<P: Pipeline>(rg: &RayGen<P>) {
        let _ = rg;
    }
}

mod program_context_without_types {
    use optix_device_rs::prelude::*;

    #[raygen]
    pub fn camera<P: Pipeline>(_: &RayGen<P>) {}

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>) {}
}

mod program_copies_its_context {
    use optix_device_rs::prelude::*;

    fn keep<P: Pipeline>(hit: &ClosestHit<P, Triangles>) -> &ClosestHit<P, Triangles> {
        hit
    }
}

mod program_default_rest {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: Vec3::ONE, rng: Pcg32::new(1, 2) }
    }
}

mod program_does_not_write_a_field {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: Vec3::ONE, rng: Pcg32::new(1, 2) }
    }
}

mod program_does_not_write_on_every_path {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }

    #[closesthit]
    pub fn shade<P: Pipeline>(hit: &ClosestHit<P, Triangles>, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
        if hit.primitive_index() == 0 {
            RadianceFromClosestHit { light: Vec3::ONE, rng: ray.rng }
        } else {
            RadianceFromClosestHit { light: Vec3::ZERO, rng: ray.rng }
        }
    }
}

mod program_dyn_record {
    use optix_device_rs::prelude::*;

    #[closesthit]
    pub fn shade<P: Pipeline, R: SbtRecord>(_: &ClosestHit<P, Triangles>, record: &R) {
        let _ = record;
    }
}

mod program_generic_hits {
    use optix_device_rs::prelude::*;

    #[anyhit]
    pub fn alpha<P: Pipeline, A: Attributes>(_: &AnyHit<P, A>) -> Decision {
        Decision::Accept
    }
}

mod program_generic_hits_of_an_intersection {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Attributes)]
    pub struct BallHit {
        pub normal: Vec3,
    }

    #[intersection]
    pub fn ball<P: Pipeline>(_: &Intersection<P, BallHit>) {}
}

mod program_generic_record {
    use optix_device_rs::prelude::*;

    #[closesthit]
    pub fn shade<P: Pipeline, R: SbtRecord>(_: &ClosestHit<P, Triangles>, record: &R) {
        let _ = record;
    }
}

mod program_generic_record_of_a_miss {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Sky {
        pub zenith: Vec3,
    }

    #[miss]
    pub fn sky<P: Pipeline>(_: &Miss<P>, record: &Sky) {
        let _ = record;
    }
}

mod program_generic_without_pipeline {
    use optix_device_rs::prelude::*;

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>) {}
}

mod program_impl_trait {
    use optix_device_rs::prelude::*;

    #[closesthit]
    pub fn shade<P: Pipeline, R: SbtRecord>(_: &ClosestHit<P, Triangles>, record: &R) {
        let _ = record;
    }
}

mod program_in_impl {
    use optix_device_rs::prelude::*;

    #[raygen]
    pub fn camera<P: Pipeline>(_: &RayGen<P>) {}
}

mod program_in_impl_unseen {
    use optix_device_rs::prelude::*;

    #[raygen]
    pub fn camera<P: Pipeline>(_: &RayGen<P>) {}
}

mod program_keeps_its_context {
    use optix_device_rs::prelude::*;

    fn keep<P: Pipeline>(hit: &ClosestHit<P, Triangles>) -> &ClosestHit<P, Triangles> {
        hit
    }
}

mod program_made_by_a_macro {
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
    shade!(lambert(RadianceAtClosestHit));
}

mod program_makes_a_context {
    use optix_device_rs::prelude::*;

    #[anyhit]
    pub fn alpha<P: Pipeline>(hit: &AnyHit<P, Triangles>) -> Decision {
        let _ = hit.primitive_index();
        Decision::Accept
    }
}

mod program_mistake_does_not_spread {
    use crate::common::*;

    #[closesthit]
    pub fn shade<P: Pipeline>(hit: &ClosestHit<P, Triangles>, record: &Lambert) -> RadianceFromClosestHit {
        let _ = hit;
        RadianceFromClosestHit { light: record.albedo }
    }

    pipeline! {
        pub struct Flat {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: shade } } },
        }
    }
}

mod program_mut_context {
    use optix_device_rs::prelude::*;

    #[raygen]
    pub fn camera<P: Pipeline>(rg: &RayGen<P>) {
        let _ = rg;
    }
}

mod program_name_taken {
    use optix_device_rs::prelude::*;

    #[allow(non_camel_case_types)]
    pub struct Sky;

    #[miss]
    pub fn sky<P: Pipeline>(_: &Miss<P>) {}
}

mod program_named_lifetime {
    use optix_device_rs::prelude::*;

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>) {}
}

fn main() {}
