// I020, I021: what programs throw is an enum by derive

mod common;
use common::*;

pub enum Fault {
    Lost,
}

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        throws: Fault,
    }
}

fn main() {}
