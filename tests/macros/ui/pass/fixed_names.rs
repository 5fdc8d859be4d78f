//! The cases about names, put right: one module each, with the name of the case.
#![allow(dead_code, unused)]

mod crate_core_is_another {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Element)]
    #[repr(C)]
    pub struct Padded {
        pub number: u32,
        pub flag: u8,
        pub pad: [u8; 3],
    }
}

mod crate_named_by_hand {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub film: SliceMut2d<Vec4>,
    }

    #[raygen]
    fn camera(_: &RayGen<Flat>) {}

    pipeline! {
        pub struct Flat {
            params: Frame,
            raygen: [camera],
        }
    }
}

mod crate_toolkit_is_another {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Element)]
    #[repr(C)]
    pub struct Full {
        pub flag: u32,
        pub number: u32,
    }

    #[launch_params]
    pub struct Frame {
        pub world: Traversable,
    }

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
    }

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Paint {
        pub colour: Vec3,
    }

    #[raygen]
    fn camera(_: &RayGen<Flat>) {}

    #[miss]
    fn sky(_: &Miss<Flat>) -> RadianceFromMiss {
        RadianceFromMiss { light: Vec3::ONE }
    }

    #[closesthit]
    fn paint(_: &ClosestHit<Flat, Triangles>, record: &Paint) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: record.colour }
    }

    pipeline! {
        pub struct Flat {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky } },
            hitgroups: { Paint on Triangles => { Radiance { closesthit: paint } } },
        }
    }
}

mod no_prelude {
    use ::optix_device_rs::prelude as rt;

    #[derive(rt::Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: rt::Vec3,
    }
}

mod raw_identifiers {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct r#Type {
        #[payload(write(caller, closesthit, miss), read(caller, closesthit))]
        pub r#fn: u32,
    }

    #[closesthit]
    pub fn r#match<P: Pipeline>(_: &ClosestHit<P, Triangles>, r#in: TypeAtClosestHit) -> TypeFromClosestHit {
        TypeFromClosestHit { r#fn: r#in.r#fn }
    }
}

fn main() {}
