//! The cases about values in registers, put right: one module each, with the name of the case.
#![allow(dead_code, unused)]

mod attributes_field {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Attributes)]
    pub struct BallHit {
        pub normal: Vec3,
    }
}

mod attributes_lifetime {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Attributes)]
    pub struct Found {
        pub normal: Vec3,
    }
}

mod attributes_reference {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Attributes)]
    pub struct Found {
        pub normals: Slice<Vec3>,
        pub first: *const Vec3,
    }
}

mod attributes_too_many {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Attributes)]
    pub struct BallHit {
        pub normal: Vec3,
        pub tangent: Vec3,
    }
}

mod words_forge_a_view {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Words)]
    pub struct Mesh {
        pub normals: Slice<f32>,
    }

    pub fn found(mesh: Mesh) -> Slice<f32> {
        mesh.normals
    }
}

mod words_enum {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Words)]
    pub struct Side {
        pub left: bool,
    }
}

mod words_field {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Words)]
    pub struct Path {
        pub length: u32,
    }
}

mod words_nested {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Words)]
    pub struct Spectrum {
        pub bands: [f32; 4],
    }

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        pub light: [Spectrum; 2],
    }
}

mod words_not_copy {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Words)]
    pub struct Id(pub u32);
}

mod attributes_forged_same_hits {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Attributes)]
    pub struct BoxHit {
        pub side: u32,
    }

    pub type CubeHit = BoxHit;
}

mod attributes_forged_triangles {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Attributes)]
    pub struct BallHit {
        pub at: Vec2,
    }

    #[closesthit]
    fn shade<P: Pipeline>(hit: &ClosestHit<P, BallHit>) {
        let _ = hit.attributes().at;
    }
}

mod attributes_of_triangles_reported {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Ball {
        pub radius: f32,
    }

    #[derive(Clone, Copy, Attributes)]
    pub struct BallHit {
        pub uv: Vec2,
    }

    #[intersection]
    fn ball<P: Pipeline>(isect: &Intersection<P, BallHit>, record: &Ball) {
        isect.report(record.radius, 0, BallHit { uv: Vec2::splat(0.25) });
    }
}

mod pipeline_intersection_by_hand {
    use optix_device_rs::prelude::*;
    use optix_device_rs::program::IntersectionProgram;

    #[launch_params]
    pub struct Frame {
        pub world: Traversable,
    }

    #[derive(Payload)]
    pub struct First {
        #[payload(write(caller, anyhit), read(anyhit, caller))]
        pub count: u32,
    }

    #[derive(Payload)]
    pub struct Second {
        #[payload(write(caller, anyhit), read(anyhit, caller))]
        pub count: u32,
    }

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Ball {
        pub radius: f32,
    }

    #[derive(Clone, Copy, Attributes)]
    pub struct Small {
        pub number: u32,
    }

    #[derive(Clone, Copy, Attributes)]
    pub struct Large {
        pub numbers: [u32; 8],
    }

    #[raygen]
    fn camera(_: &RayGen<Flat>) {}

    #[allow(non_camel_case_types)]
    pub struct ball {}
    impl IntersectionProgram<Flat, Ball, First> for ball {
        type Attributes = Small;
        fn run(isect: &Intersection<Flat, Small>, _: &Ball, _: ()) {
            isect.report(1.0, 0, Small { number: 1 });
        }
    }
    impl IntersectionProgram<Flat, Ball, Second> for ball {
        type Attributes = Small;
        fn run(isect: &Intersection<Flat, Small>, _: &Ball, _: ()) {
            isect.report(1.0, 0, Small { number: 2 });
        }
    }

    pipeline! {
        pub struct Flat {
            params: Frame,
            raygen: [camera],
            rays: { First {}, Second {} },
            hitgroups: { Ball on Custom => { First { intersection: ball }, Second { intersection: ball } } },
        }
    }
}

fn main() {}
