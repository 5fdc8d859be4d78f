//! The cases about pipelines, put right: one module each, with the name of the case.
#![allow(dead_code, unused)]

#[path = "../common/mod.rs"]
mod common;

mod pipeline_bound_on_params {
    use crate::common::*;

    #[launch_params]
    pub struct Other {
        pub count: u32,
    }

    #[raygen]
    pub fn count<P: Pipeline<Params = Other>>(rg: &RayGen<P>) {
        let _ = rg.params().count();
    }

    pipeline! {
        pub struct PathTracer { params: Other, raygen: [count], rays: { Radiance { miss: sky } } }
    }
}

mod pipeline_cfg_entry {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky } },
            hitgroups: {
                Lambert on Triangles => { Radiance { closesthit: lambert, anyhit: all } },
            },
        }
    }
}

mod pipeline_cfg_inside {
    use crate::common::*;

    #[cfg(debug_assertions)]
    pipeline! {
        pub struct PathTracer { params: Frame, raygen: [camera], rays: { Radiance { miss: sky } } }
    }
}

mod pipeline_closesthit_in_rays {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        }
    }
}

mod pipeline_closesthit_missing {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert, anyhit: all }, Shadow {} } },
        }
    }
}

mod pipeline_custom_without_intersection {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Ball on Custom => { Radiance { closesthit: ball_shade, intersection: ball }, Shadow { intersection: ball } } },
        }
    }
}

mod pipeline_forged_params {
    use optix_device_rs::params::{Field, LaunchParams};
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Mine {
        pub count: u32,
    }
}

mod pipeline_forged_ray {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer { params: Frame, raygen: [camera], rays: { Radiance { miss: sky }, Shadow { miss: lit } } }
    }
}

mod pipeline_generic {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky } },
        }
    }
}

mod pipeline_group_twice {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: {
                Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} },
            },
        }
    }
}

mod pipeline_group_without_geometry {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        }
    }
}

mod pipeline_intersections_disagree {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: {
                Ball on Custom => {
                    Radiance { intersection: ball, closesthit: ball_shade },
                    Shadow { intersection: ball },
                },
            },
        }
    }
}

mod pipeline_key_twice {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        }
    }
}

mod pipeline_keyword {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer { params: Frame, raygen: [camera], rays: { Radiance { miss: sky } } }
    }
}

mod pipeline_made_by_a_macro {
    use crate::common::*;

    macro_rules! renderer {
        ($name:ident: $record:ty => $shade:path) => {
            pipeline! {
                pub struct $name {
                    params: $crate::common::Frame,
                    raygen: [camera],
                    rays: { Radiance { miss: sky } },
                    hitgroups: { $record on Triangles => { Radiance { closesthit: $shade } } },
                }
            }
        };
    }
    renderer!(PathTracer: Lambert => lambert);
}

mod pipeline_miss_in_group {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        }
    }
}

mod pipeline_miss_missing {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        }
    }
}

mod pipeline_missing_comma {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        }
    }
}

mod pipeline_mistake_does_not_spread {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub film: SliceMut2d<Vec4>,
        pub world: Traversable,
    }

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: Vec3,
    }

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Lambert {
        pub albedo: Vec3,
    }

    #[raygen]
    fn camera(rg: &RayGen<PathTracer>) {
        let hit = rg.trace::<Radiance>(rg.params().world(), Ray::new(Vec3::ZERO, Vec3::X), ());
        rg.params().film().set(rg.launch_index().xy(), hit.light.extend(1.0));
    }

    #[closesthit]
    fn lambert(_: &ClosestHit<PathTracer, Triangles>, record: &Lambert) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: record.albedo }
    }

    #[miss]
    fn sky(_: &Miss<PathTracer>) -> RadianceFromMiss {
        RadianceFromMiss { light: Vec3::ONE }
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert } } },
        }
    }
}

mod pipeline_nine_rays {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky } },
        }
    }
}

mod pipeline_no_params {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        }
    }
}

mod pipeline_no_raygen {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        }
    }
}

mod pipeline_not_a_struct {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer { params: Frame, raygen: [camera], rays: { Radiance { miss: sky } } }
    }
}

mod pipeline_params_not_params {
    use crate::common::*;

    #[raygen]
    pub fn noise<P: Pipeline>(_: &RayGen<P>) {}

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [noise],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        }
    }
}

mod pipeline_program_cfged_out {
    use crate::common::*;

    #[anyhit]
    pub fn alpha<P: Pipeline>(_: &AnyHit<P, Triangles>) -> Decision {
        Decision::Ignore
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert, anyhit: alpha } } },
        }
    }
}

mod pipeline_program_does_not_write {
    use crate::common::*;

    #[closesthit]
    pub fn nothing<P: Pipeline>(_: &ClosestHit<P, Triangles>) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: Vec3::ZERO }
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: nothing }, Shadow {} } },
        }
    }
}

mod pipeline_program_needs_another_ray {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        }
    }
}

mod pipeline_program_of_another_geometry {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: {
                Ball on Custom => {
                    Radiance { intersection: ball, closesthit: ball_shade },
                    Shadow { intersection: ball },
                },
            },
        }
    }
}

mod pipeline_program_of_another_kind {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        }
    }
}

mod pipeline_program_of_another_payload {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        }
    }
}

fn main() {}
