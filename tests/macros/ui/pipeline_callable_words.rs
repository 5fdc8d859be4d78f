// I002: a call passes 32 words at most

mod common;
use common::*;

#[direct_callable]
fn wood<P: Pipeline>(_: &DirectCallable<P>, at: [Vec4; 9]) -> Vec4 {
    at[0]
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
