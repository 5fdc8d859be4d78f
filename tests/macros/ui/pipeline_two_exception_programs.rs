// I023, C048: a pipeline has one exception program

mod common;
use common::*;

#[exception]
fn report<P: Pipeline>(_: &Exception<P>) {}

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        exception: [report, report],
    }
}

fn main() {}
