// I017, I020: a pipeline whose programs throw says so

mod common;
use common::*;

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    Lost,
}

#[direct_callable]
fn wood<P: Throws<Fault>>(dc: &DirectCallable<P>) {
    dc.throw(Fault::Lost);
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
