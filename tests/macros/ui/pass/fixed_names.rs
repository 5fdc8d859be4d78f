//! The cases about names, put right: one module each, with the name of the case.
#![allow(dead_code, unused)]

mod crate_as_text {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    #[optix(crate = ::optix_device_rs)]
    pub struct Probe {
        #[payload(write(caller), read(closesthit))]
        pub id: u32,
    }

    #[closesthit(crate = ::optix_device_rs)]
    pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>) {}
}

mod crate_not_there {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    #[optix(crate = ::optix_device_rs)]
    pub struct Probe {
        #[payload(write(caller), read(closesthit))]
        pub id: u32,
    }
}

mod crate_option_unknown {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Words)]
    #[optix(crate = optix_device_rs)]
    pub struct Id(pub u32);
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
