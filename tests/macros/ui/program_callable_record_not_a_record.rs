// I012, D004: a callable reads a record

use optix_device_rs::prelude::*;

pub struct Wood {
    pub colour: Vec3,
}

#[direct_callable]
fn wood<P: Pipeline>(_: &DirectCallable<P>, record: &Wood) -> Vec3 {
    record.colour
}

fn main() {}
