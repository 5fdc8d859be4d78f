// D004, D009: a record is a struct that derives SbtRecord

use optix_device_rs::prelude::*;

pub struct Paint {
    pub colour: Vec3,
}

#[miss]
pub fn sky<P: Pipeline>(_: &Miss<P>, record: &Paint) {
    let _ = record.colour;
}

fn main() {}
