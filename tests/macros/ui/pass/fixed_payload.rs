//! The cases about payloads, put right: one module each, with the name of the case.
#![allow(dead_code, unused)]

mod payload_anyhit_reads_unwritten {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(caller, anyhit, closesthit, miss), read(anyhit, caller))]
        pub count: u32,
    }
}

mod payload_attribute_twice {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(caller), read(closesthit))]
        pub light: Vec3,
    }
}

mod payload_bad_grammar {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(caller), read(caller))]
        pub light: Vec3,
        #[payload(write(caller), read(caller))]
        pub seed: u32,
    }
}

mod payload_caller_reads_unwritten_on_hit {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub visible: bool,
    }
}

mod payload_caller_reads_unwritten_on_miss {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
    }
}

mod payload_caller_reads_what_anyhit_writes {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(caller, anyhit), read(caller))]
        pub count: u32,
    }
}

mod payload_closesthit_reads_unwritten {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(caller, closesthit, miss), read(closesthit, caller))]
        pub seed: u32,
    }
}

mod payload_closesthit_reads_what_anyhit_writes {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(caller, anyhit), read(closesthit))]
        pub nearest: u32,
    }
}

mod payload_duplicate_party {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(caller), read(miss))]
        pub seed: u32,
    }
}

mod payload_empty_list {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
    }
}

mod payload_enum {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: f32,
    }
}

mod payload_field_not_words {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub name: u32,
    }
}

mod payload_forged_part {
    use optix_device_rs::payload::Part;
    use optix_device_rs::prelude::*;
    use optix_device_rs::words::WordBuffer;

    #[derive(Payload)]
    pub struct Everything {
        #[payload(write(caller, closesthit, miss), read(caller, closesthit, miss))]
        pub words: [u32; 32],
    }
}

mod payload_generic {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
    }
}

mod payload_intersection_reads_unwritten {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(caller, intersection), read(intersection))]
        pub count: u32,
    }
}

mod payload_lifetime {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Path {
        #[payload(write(caller), read(closesthit))]
        pub seeds: [u32; 4],
    }
}

mod payload_lost_write {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub throughput: Vec3,
    }
}

mod payload_made_by_a_macro {
    use optix_device_rs::prelude::*;

    macro_rules! payload {
        ($name:ident { $($field:ident: $ty:ty),* }) => {
            #[derive(Payload)]
            pub struct $name {
                $(#[payload(write(closesthit, miss), read(caller))] pub $field: $ty,)*
            }
        };
    }
    payload!(Radiance { light: Vec3, depth: u32 });
}

mod payload_mistake_does_not_spread {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
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
}

mod payload_never_read {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
    }
}

mod payload_never_written {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
    }
}

mod payload_no_attribute {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller), read(miss))]
        pub seed: u32,
    }
}

mod payload_own_part {
    use optix_device_rs::prelude::*;

    pub struct Other;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(caller, closesthit), read(closesthit, caller))]
        pub rng: Pcg32,
    }
}

mod payload_own_u32 {
    use optix_device_rs::prelude::*;

    #[allow(non_camel_case_types)]
    type u32 = usize;

    #[derive(Payload)]
    pub struct Count {
        #[payload(write(caller, anyhit), read(anyhit, caller))]
        pub hits: core::primitive::u32,
    }
}

mod payload_reference {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Path {
        #[payload(write(caller), read(closesthit))]
        pub seed: u32,
        #[payload(write(caller), read(closesthit))]
        pub raw: *const u32,
    }
}

mod payload_transport_unknown {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    #[payload(transport = pointer)]
    pub struct Path {
        #[payload(write(caller), read(closesthit))]
        pub matrix: [f32; 40],
    }
}

mod payload_transport_twice {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    #[payload(transport = registers)]
    pub struct Path {
        #[payload(write(caller), read(closesthit))]
        pub seed: u32,
    }
}

mod payload_transport_of_a_field {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    #[payload(transport = pointer)]
    pub struct Path {
        #[payload(write(caller), read(closesthit))]
        pub matrix: [f32; 40],
    }
}

mod payload_parties_of_the_struct {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Path {
        #[payload(write(caller), read(closesthit))]
        pub seed: u32,
    }
}

mod payload_pointer_reads_unwritten {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    #[payload(transport = pointer)]
    pub struct Path {
        #[payload(write(closesthit, miss), read(caller))]
        pub vertices: [Vec3; 20],
    }
}

mod payload_three_mistakes_at_once {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
        #[payload(write(closesthit, miss), read(caller))]
        pub seed: u32,
        #[payload(write(caller), read(closesthit))]
        pub depth: u32,
    }
}

mod payload_too_many_words {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(caller), read(closesthit))]
        pub matrix: [f32; 29],
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
    }
}

mod payload_tuple {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
    }
}

mod payload_unknown_party {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(caller, closesthit), read(caller))]
        pub light: Vec3,
    }
}

mod payload_instance_handle {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Found {
        #[payload(write(caller, closesthit), read(caller))]
        pub instance: u64,
    }
}

mod payload_forged_nothing_to_write {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
    }

    #[miss]
    fn dark<P: Pipeline>(_: &Miss<P>) -> RadianceFromMiss {
        RadianceFromMiss { light: Vec3::ZERO }
    }
}

fn main() {}
