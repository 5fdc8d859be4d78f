//! The cases about exceptions, put right: one module each, with the name of the case.
#![allow(dead_code, unused)]

#[path = "../common/mod.rs"]
mod common;

mod device_throw_undeclared {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        Lost,
    }

    #[raygen]
    pub fn program<P: Throws<Fault>>(rg: &RayGen<P>) {
        rg.throw(Fault::Lost);
    }
}

mod exception_code_negative {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        Lost = 0,
    }
}

mod exception_code_runs_over {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        Lost,
        Last = (1 << 30) - 1,
    }
}

mod exception_code_too_large {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        Lost = (1 << 30) - 1,
    }
}

mod exception_code_twice {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        Lost = 7,
        Found = 8,
    }
}

mod exception_details_not_words {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Words)]
    pub struct Place {
        pub at: Vec3,
    }

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        At(Place),
    }
}

mod exception_details_of_another_variant {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        Lost,
        At { pixel: UVec2 },
    }

    #[exception]
    fn report<P: Pipeline<Exception = Fault>>(ex: &Exception<P>) {
        if let Raised::User(Fault::At { pixel }) = ex.raised() {
            let _ = pixel;
        }
    }
}

mod exception_empty {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        Lost,
    }
}

mod exception_generic {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        At(Vec3),
    }
}

mod exception_not_copy {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        Lost,
    }
}

mod exception_of_another_type {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        Lost,
    }

    #[derive(Clone, Copy, UserException)]
    pub enum Other {
        Broken(u32),
    }

    #[exception]
    fn report<P: Pipeline<Exception = Other>>(ex: &Exception<P>) {
        if let Raised::User(Other::Broken(_)) = ex.raised() {}
    }
}

mod exception_reference {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        At(u32),
    }
}

mod exception_struct {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        At { pixel: UVec2 },
    }
}

mod exception_too_many_details {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        Lost,
        At { rows: [Vec3; 2], w: Vec2 },
    }
}

mod pipeline_exception_of_another_kind {
    use crate::common::*;

    #[exception]
    fn report<P: Pipeline>(_: &Exception<P>) {}

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
            exception: report,
        }
    }
}

mod pipeline_throws_another {
    use crate::common::*;

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        Lost,
    }

    #[direct_callable]
    fn wood<P: Throws<Fault>>(dc: &DirectCallable<P>) {
        dc.throw(Fault::Lost);
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
            direct_callables: [wood],
            throws: Fault,
        }
    }
}

mod pipeline_throws_no_exception {
    use crate::common::*;

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        Lost,
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
            throws: Fault,
        }
    }
}

mod pipeline_throws_undeclared {
    use crate::common::*;

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        Lost,
    }

    #[direct_callable]
    fn wood<P: Throws<Fault>>(dc: &DirectCallable<P>) {
        dc.throw(Fault::Lost);
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
            direct_callables: [wood],
            throws: Fault,
        }
    }
}

mod pipeline_two_exception_programs {
    use crate::common::*;

    #[exception]
    fn report<P: Pipeline>(_: &Exception<P>) {}

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
            exception: report,
        }
    }
}

mod program_exception_returns {
    use optix_device_rs::prelude::*;

    #[exception]
    fn report<P: Pipeline>(ex: &Exception<P>) {
        let _ = ex.exception_code();
    }
}

mod program_exception_with_payload {
    use optix_device_rs::prelude::*;

    #[exception]
    fn report<P: Pipeline>(_: &Exception<P>) {}
}

mod exception_code_beyond_64_bits {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, UserException)]
    #[repr(i128)]
    pub enum Fault {
        View { at: Slice<u32> } = (1 << 30) - 1,
        Numbers { low: u64, high: u64 } = 0,
    }

    #[derive(Clone, Copy, UserException)]
    #[repr(u128)]
    pub enum Huge {
        Most = 1 + 1,
    }
}

mod exception_thrown_by_declaration {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub faults: SliceMut<u32>,
    }

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        View { at: Slice<u32> },
    }

    #[derive(Clone, Copy, UserException)]
    pub enum Other {
        Numbers { low: u64, high: u64 },
    }

    #[raygen]
    fn camera(rg: &RayGen<Flat>) {
        rg.throw(Fault::View { at: Slice::EMPTY })
    }

    pipeline! {
        pub struct Flat {
            params: Frame,
            raygen: [camera],
            throws: Fault,
        }
    }
}

mod exception_codes_by_a_constant_of_the_derive {
    use optix_device_rs::prelude::*;

    const NINE: u32 = 9;

    #[derive(Clone, Copy, UserException)]
    #[repr(u32)]
    pub enum Fault {
        View { at: Slice<u32> } = 3,
        Words { words: [u32; 4] } = NINE,
    }
}

fn main() {}
