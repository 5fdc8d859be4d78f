// T02: a mistake in a program is not reported by its pipeline

mod common;
use common::*;

#[closesthit]
pub fn shade<P: Pipeline>(hit: &mut ClosestHit<P, Triangles>, record: &Lambert) -> RadianceFromClosestHit {
    let _ = hit;
    RadianceFromClosestHit { light: record.albedo }
}

pipeline! {
    pub struct Flat {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: shade } } },
    }
}

fn main() {}
