// D004, T02: a record is copied to the device; what uses it says no more

mod common;
use common::*;

#[derive(SbtRecord)]
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
