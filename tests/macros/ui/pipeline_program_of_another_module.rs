// C013: a program is named by a path

mod common;
use common::*;

mod sky_model {
    use super::*;

    #[miss]
    pub fn hazy<P: Pipeline>(_: &Miss<P>) -> RadianceFromMiss {
        RadianceFromMiss { light: Vec3::ONE }
    }
}

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: hazy } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert } } },
    }
}

fn main() {}
