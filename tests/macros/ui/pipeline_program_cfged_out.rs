// T07: a pipeline lists programs that there are

mod common;
use common::*;

#[cfg(target_arch = "nvptx64")]
#[anyhit]
pub fn alpha<P: Pipeline>(_: &AnyHit<P, Triangles>) -> Decision {
    Decision::Ignore
}

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert, anyhit: alpha } } },
    }
}

fn main() {}
