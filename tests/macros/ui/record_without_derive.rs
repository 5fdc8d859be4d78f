// T02: a record has its derive

mod common;
use common::*;

#[derive(Clone, Copy)]
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

fn main() {}
