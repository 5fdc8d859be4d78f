//! The cases about pipelines, put right: one module each, with the name of the case.
#![allow(dead_code, unused)]

#[path = "../common/mod.rs"]
mod common;

mod pipeline_program_of_another_pipeline {
    use crate::common::*;

    #[raygen]
    pub fn fixed(_: &RayGen<Other>) {}

    pipeline! {
        pub struct Other { params: Frame, raygen: [fixed] }
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        }
    }
}

mod pipeline_program_of_another_record {
    use crate::common::*;

    #[closesthit]
    pub fn matt<P: Pipeline>(_: &ClosestHit<P, Triangles>, record: &Lambert) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: record.albedo }
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: {
                Lambert on Triangles => { Radiance { closesthit: matt }, Shadow {} },
            },
        }
    }
}

mod pipeline_program_with_generics {
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

mod pipeline_program_without_attribute {
    use crate::common::*;

    #[miss]
    pub fn black<P: Pipeline>(_: &Miss<P>) -> RadianceFromMiss {
        RadianceFromMiss { light: Vec3::ZERO }
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: black }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        }
    }
}

mod pipeline_ray_alias {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        }
    }
}

mod pipeline_ray_missing_in_group {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: {
                Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} },
                Ball on Custom => { Radiance { intersection: ball, closesthit: ball_shade }, Shadow { intersection: ball } },
            },
        }
    }
}

mod pipeline_ray_not_a_payload {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        }
    }
}

mod pipeline_ray_twice {
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

mod pipeline_ray_twice_in_group {
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

mod pipeline_ray_unknown_in_group {
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

mod pipeline_ray_with_bounds {
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

mod pipeline_raygen_twice {
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

mod pipeline_record_alias {
    use crate::common::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Matt {
        pub grey: f32,
    }

    #[closesthit]
    pub fn matt<P: Pipeline>(_: &ClosestHit<P, Triangles>, record: &Matt) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: Vec3::splat(record.grey) }
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky } },
            hitgroups: {
                Lambert on Triangles => { Radiance { closesthit: lambert } },
                Matt on Triangles => { Radiance { closesthit: matt } },
            },
        }
    }
}

mod pipeline_trace_depth {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
            trace_depth: 31,
        }
    }
}

mod pipeline_triangles_with_intersection {
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

mod pipeline_custom_without_any_intersection {
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

mod pipeline_on_no_primitive {
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

mod pipeline_unknown_geometry {
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

mod pipeline_unknown_keys {
    use crate::common::*;

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: {},
        }
    }
}

mod pipeline_unknown_program_kind {
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

mod pipeline_where_clause {
    use crate::common::*;

    #[miss]
    pub fn haze<P>(ms: &Miss<P>) -> RadianceFromMiss
    where
        P: HasRay<Radiance> + HasRay<Shadow>,
    {
        RadianceFromMiss { light: ms.world_ray_direction() }
    }

    pipeline! {
        pub struct PathTracer { params: Frame, raygen: [camera], rays: { Radiance { miss: haze }, Shadow { miss: lit } } }
    }
}

fn main() {}
