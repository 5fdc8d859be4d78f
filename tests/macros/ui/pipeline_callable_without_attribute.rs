// I011, C013: a callable has an attribute

mod common;
use common::*;

fn wood<P: Pipeline>(_: &DirectCallable<P>, uv: Vec2) -> Vec3 {
    uv.extend(0.0)
}

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        direct_callables: [wood],
    }
}

fn main() {}
