// D018: a callable is listed once

mod common;
use common::*;

#[direct_callable]
fn wood<P: Pipeline>(_: &DirectCallable<P>, uv: Vec2) -> Vec3 {
    uv.extend(0.0)
}

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        direct_callables: [wood, wood],
    }
}

fn main() {}
