//! The cases about programs, put right: one module each, with the name of the case.
#![allow(dead_code, unused)]

mod program_too_many_arguments {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Lambert {
        pub albedo: Vec3,
    }

    #[miss]
    pub fn sky<P: Pipeline>(_: &Miss<P>, record: &Lambert) -> RadianceFromMiss {
        RadianceFromMiss { light: record.albedo }
    }
}

mod program_traces_a_foreign_ray {
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
        rg.trace::<Radiance>(
            Traversable::NULL,
            Ray::new(Vec3::ZERO, Vec3::X),
            RadianceFromCaller { rng: Pcg32::new(1, 2) },
        );
    }
}

mod program_two_kinds {
    use optix_device_rs::prelude::*;

    #[anyhit]
    pub fn alpha<P: Pipeline>(_: &AnyHit<P, Triangles>) -> Decision {
        Decision::Accept
    }
}

mod program_unknown_parameter {
    use optix_device_rs::prelude::*;

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>) {}
}

mod program_with_arguments {
    use optix_device_rs::prelude::*;

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>) {}
}

mod program_wrong_context {
    use optix_device_rs::prelude::*;

    #[closesthit]
    pub fn shade<P: Pipeline>(hit: &ClosestHit<P, Triangles>) {
        let _ = hit;
    }
}

fn main() {}
