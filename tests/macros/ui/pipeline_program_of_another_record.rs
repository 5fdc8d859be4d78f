// D009: the programs of a material read its record

mod common;
use common::*;

#[closesthit]
pub fn matt<P: Pipeline>(_: &ClosestHit<P, Triangles>, record: &Ball) -> RadianceFromClosestHit {
    RadianceFromClosestHit { light: record.sphere.xyz() }
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

fn main() {}
