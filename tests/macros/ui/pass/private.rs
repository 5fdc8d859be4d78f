//! Nothing has to be public, and no lint complains about what only the other machine uses.
#![deny(warnings, unused, missing_docs, unreachable_pub, unsafe_code, unused_qualifications, missing_debug_implementations)]
#![deny(clippy::all, clippy::pedantic)]

mod scene {
    use optix_device_rs::prelude::*;

    #[launch_params]
    struct Frame {
        world: Traversable,
        #[bound]
        depth: u32,
    }

    #[derive(Payload)]
    struct Radiance {
        #[payload(write(closesthit, miss), read(caller))]
        light: Vec3,
    }

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    struct Paint {
        colour: Vec3,
        only_for_later: u32,
    }

    #[raygen]
    fn camera(rg: &RayGen<Flat>) {
        let _ = rg.trace::<Radiance>(rg.params().world(), Ray::new(Vec3::ZERO, Vec3::X), ()).light;
    }

    #[closesthit]
    fn shade(_: &ClosestHit<Flat, Triangles>, record: &Paint) -> RadianceFromClosestHit {
        RadianceFromClosestHit { light: record.colour }
    }

    #[miss]
    fn sky(_: &Miss<Flat>) -> RadianceFromMiss {
        RadianceFromMiss { light: Vec3::ONE }
    }

    pipeline! {
        struct Flat {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky } },
            hitgroups: { Paint on Triangles => { Radiance { closesthit: shade } } },
        }
    }

    pub(crate) fn size() -> usize {
        Flat::DESCRIPTION.params.size
    }
}

fn main() {
    assert_eq!(scene::size(), 16);
}
