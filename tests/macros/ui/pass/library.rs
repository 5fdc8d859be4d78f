//! Programs for other people's pipelines: generic in the pipeline, the hits and the record.
#![deny(warnings)]

mod library {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Shadow {
        #[payload(write(caller, miss), read(caller))]
        pub visible: bool,
    }

    #[miss]
    pub fn lit<P: Pipeline>(_: &Miss<P>) -> ShadowFromMiss {
        ShadowFromMiss { visible: true }
    }

    #[anyhit]
    pub fn through<P: Pipeline, A: Attributes>(_: &AnyHit<P, A>) -> Decision {
        Decision::Ignore
    }

    #[closesthit]
    pub fn nothing<P, A: Attributes, R>(_: &ClosestHit<P, A>, record: &R)
    where
        P: Pipeline + HasRay<Shadow>,
        R: SbtRecord,
    {
        let _ = record;
    }
}

use optix_device_rs::prelude::*;

#[launch_params]
pub struct Frame {
    pub world: Traversable,
}

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Glass;

#[raygen]
fn camera(rg: &RayGen<Flat>) {
    let shadow = library::ShadowFromCaller { visible: false };
    rg.trace::<library::Shadow>(rg.params().world(), Ray::new(Vec3::ZERO, Vec3::X), shadow);
}

pipeline! {
    pub struct Flat {
        params: Frame,
        raygen: [camera],
        rays: { library::Shadow { miss: library::lit } },
        hitgroups: {
            Glass on Triangles => { library::Shadow { closesthit: library::nothing, anyhit: library::through } },
        },
    }
}

fn main() {}
