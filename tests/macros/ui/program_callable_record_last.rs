// I012: the record of a callable comes before its arguments

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Wood {
    pub colour: Vec3,
}

#[direct_callable]
fn wood<P: Pipeline>(_: &DirectCallable<P>, share: f32, record: &Wood) -> Vec3 {
    record.colour * share
}

fn main() {}
