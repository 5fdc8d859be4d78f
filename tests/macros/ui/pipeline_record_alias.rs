// D027, T03: two names of one record are one material

mod common;
use common::*;

type Matt = Lambert;

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky } },
        hitgroups: {
            Lambert on Triangles => { Radiance { closesthit: lambert } },
            Matt on Triangles => { Radiance { closesthit: lambert } },
        },
    }
}

fn main() {}
