// C013: a program has its kind's attribute

mod common;
use common::*;

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

fn main() {}
