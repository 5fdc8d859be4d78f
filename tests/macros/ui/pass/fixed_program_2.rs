//! The cases about programs, put right: one module each, with the name of the case.
#![allow(dead_code, unused)]

mod program_no_arguments {
    use optix_device_rs::prelude::*;

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>) {}
}

mod program_no_context {
    use optix_device_rs::prelude::*;

    #[miss]
    pub fn sky<P: Pipeline>(index: &Miss<P>) {
        let _ = index;
    }

    #[miss]
    pub fn ground<P: Pipeline>(index: &Miss<P>) {
        let _ = index;
    }
}

mod program_on_a_struct {
    use optix_device_rs::prelude::*;

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>) {}
}

mod program_own_context {
    use optix_device_rs::prelude::*;

    #[miss]
    pub fn sky<P: Pipeline>(_: &Miss<P>) {}
}

mod program_own_decision {
    use optix_device_rs::prelude::*;

    #[anyhit]
    pub fn alpha<P: Pipeline>(hit: &AnyHit<P, Triangles>) -> Decision {
        if hit.barycentrics().x > 0.5 { Decision::Ignore } else { Decision::Accept }
    }
}

mod program_own_part {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Glow {
        #[payload(write(caller), read(closesthit))]
        pub light: Vec3,
    }

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, ray: GlowAtClosestHit) {
        let _ = ray.light;
    }
}

mod program_own_triangles {
    use optix_device_rs::prelude::*;

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>) {}
}

mod program_part_alias {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: Vec3::ONE, rng: ray.rng }
    }
}

mod program_part_of_a_parameter {
    use optix_device_rs::prelude::*;

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>) {}
}

mod program_part_of_another_party {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: Vec3::ONE, rng: ray.rng }
    }
}

mod program_payload_before_record {
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

    #[closesthit]
    pub fn shade<P: Pipeline>(
        _: &ClosestHit<P, Triangles>,
        record: &Lambert,
        ray: RadianceAtClosestHit,
    ) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: record.albedo, rng: ray.rng }
    }
}

mod program_payload_by_reference {
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

    #[closesthit]
    pub fn shade<P: Pipeline>(
        _: &ClosestHit<P, Triangles>,
        record: &Lambert,
        ray: RadianceAtClosestHit,
    ) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: record.albedo, rng: ray.rng }
    }
}

mod program_payload_itself {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: Vec3::ONE, rng: ray.rng }
    }
}

mod program_private_record {
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

mod program_qualifiers {
    use optix_device_rs::prelude::*;

    #[raygen]
    pub fn one<P: Pipeline>(_: &RayGen<P>) {}

    #[raygen]
    pub fn two<P: Pipeline>(_: &RayGen<P>) {}

    #[raygen]
    pub fn three<P: Pipeline>(_: &RayGen<P>) {}

    #[raygen]
    pub fn four<P: Pipeline>(_: &RayGen<P>) {}
}

mod program_raygen_with_payload {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }

    #[raygen]
    pub fn camera<P: Pipeline>(_: &RayGen<P>) {}

    #[raygen]
    pub fn lens<P: Pipeline>(_: &RayGen<P>) {}
}

mod program_reads_a_field_it_may_not {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: Vec3::ONE, rng: ray.rng }
    }
}

mod program_record_by_value {
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

    #[closesthit]
    pub fn shade<P: Pipeline>(
        _: &ClosestHit<P, Triangles>,
        record: &Lambert,
        ray: RadianceAtClosestHit,
    ) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: record.albedo, rng: ray.rng }
    }
}

mod program_record_by_value_alone {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Lambert {
        pub albedo: Vec3,
    }

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, record: &Lambert) {
        let _ = record.albedo;
    }
}

mod program_record_mut {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Lambert {
        pub albedo: Vec3,
    }

    #[miss]
    pub fn sky<P: Pipeline>(_: &Miss<P>, record: &Lambert) {
        let _ = record.albedo;
    }
}

mod program_record_not_a_record {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Paint {
        pub colour: Vec3,
    }

    #[miss]
    pub fn sky<P: Pipeline>(_: &Miss<P>, record: &Paint) {
        let _ = record.colour;
    }
}

mod program_reports_foreign_attributes {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Attributes)]
    pub struct BallHit {
        pub normal: Vec3,
    }

    #[intersection]
    pub fn ball<P: Pipeline>(isect: &Intersection<P, BallHit>) {
        isect.report(1.0, 0, BallHit { normal: Vec3::X });
    }
}

mod program_rest_of_another_part {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: Vec3::ONE, rng: ray.rng }
    }
}

mod program_result_of_another_party {
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

mod program_result_of_another_payload {
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
        #[payload(write(closesthit, miss), read(caller))]
        pub visible: bool,
    }

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: Vec3::ONE, rng: ray.rng }
    }
}

mod program_returns_a_result {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }

    #[miss]
    pub fn sky<P: Pipeline>(_: &Miss<P>) -> RadianceFromMiss {
        RadianceFromMiss { light: Vec3::ONE }
    }
}

mod program_returns_an_option {
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
        let light = if hit.primitive_index() == 0 { Vec3::ONE } else { Vec3::ZERO };
        RadianceFromClosestHit { light, rng: ray.rng }
    }
}

mod program_returns_nothing {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }

    #[closesthit]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: Vec3::ONE, rng: ray.rng }
    }
}

mod program_self {
    use optix_device_rs::prelude::*;

    #[raygen]
    pub fn camera<P: Pipeline>(_: &RayGen<P>) {}
}

mod program_static_record {
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

fn main() {}
