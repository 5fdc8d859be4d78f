// T02: one mistake in a pipeline is one error

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
        hitgroups: { Lambert on Triangles => { Radiance { closest_hit: lambert } } },
    }
}

fn main() {}
