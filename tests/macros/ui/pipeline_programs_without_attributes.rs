// C013: a program of any kind has its attribute

mod common;
use common::*;

pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>, record: &Lambert) -> RadianceFromClosestHit {
    RadianceFromClosestHit { light: record.albedo }
}

pub fn start<P: HasRay<Radiance> + Pipeline<Params = Frame>>(_: &RayGen<P>) {}

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [start],
        rays: { Radiance { miss: sky } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: shade } } },
    }
}

fn main() {}
