// I020, I024: a pipeline throws exceptions of one type

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

#[derive(Clone, Copy, UserException)]
pub enum Other {
    Broken,
}

pipeline! {
    pub struct PathTracer {
        params: Frame,
        raygen: [camera],
        rays: { Radiance { miss: sky }, Shadow { miss: lit } },
        hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
        direct_callables: [wood],
        throws: Other,
    }
}

fn main() {}
