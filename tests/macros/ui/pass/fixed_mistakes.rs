//! Mistakes of a first hour, put right: one module each, with the name of the case.
#![allow(dead_code, unused)]

#[path = "../common/mod.rs"]
mod common;

mod device_indexes_by_brackets {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub film: SliceMut2d<Vec4>,
        pub counts: SliceMut<u32>,
        pub normals: Slice<Vec3>,
    }

    #[raygen]
    pub fn camera<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
        let i = rg.launch_index().x;
        rg.params().counts().set(i, 4);
        let _ = rg.params().normals().get(i);
        let _ = rg.params().film().get(rg.launch_index().xy());
    }
}

mod device_indexes_by_usize {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub counts: SliceMut<u32>,
    }

    #[raygen]
    pub fn camera<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
        let i: u32 = 4;
        rg.params().counts().set(i, 4);
    }
}

mod device_reads_params_as_fields {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub count: u32,
    }

    #[raygen]
    pub fn camera<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
        let _ = rg.params().count();
    }
}

mod element_not_copy {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Element)]
    #[repr(C)]
    pub struct Vertex {
        pub position: Vec3,
    }

    #[launch_params]
    pub struct Frame {
        pub vertices: Slice<Vertex>,
    }

    #[raygen]
    pub fn camera<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
        let _ = rg.params().vertices().get(0).position;
    }
}

mod pipeline_payload_misspelt {
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

mod pipeline_ray_by_another_name {
    use crate::common::*;

    type Glow = Radiance;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Glow { miss: sky } },
            hitgroups: { Lambert on Triangles => { Glow { closesthit: lambert } } },
        }
    }
}

mod pipeline_record_misspelt {
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

mod record_not_copy_in_a_pipeline {
    use crate::common::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Matt {
        pub albedo: Vec3,
    }

    #[closesthit]
    pub fn matt(_: &ClosestHit<PathTracer, Triangles>, record: &Matt) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: record.albedo }
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky } },
            hitgroups: { Matt on Triangles => { Radiance { closesthit: matt } } },
        }
    }
}

mod payload_without_derive {
    use crate::common::Frame;
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Glow {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
    }

    #[raygen]
    pub fn look(rg: &RayGen<PathTracer>) {
        let _ = rg.trace::<Glow>(rg.params().world(), Ray::new(Vec3::ZERO, Vec3::X), ());
    }

    #[miss]
    pub fn dusk(_: &Miss<PathTracer>) -> GlowFromMiss {
        GlowFromMiss { light: Vec3::ONE }
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [look],
            rays: { Glow { miss: dusk } },
        }
    }
}

mod pipeline_private_params {
    use crate::common::{Radiance, sky};
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        count: u32,
    }

    #[raygen]
    fn camera(rg: &RayGen<PathTracer>) {
        let _ = rg.params().count();
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky } },
        }
    }
}

mod record_without_derive {
    use crate::common::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Matt {
        pub albedo: Vec3,
    }

    #[closesthit]
    pub fn matt(_: &ClosestHit<PathTracer, Triangles>, record: &Matt) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: record.albedo }
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky } },
            hitgroups: { Matt on Triangles => { Radiance { closesthit: matt } } },
        }
    }
}

fn main() {}
