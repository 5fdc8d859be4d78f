// T03, G054: hits of the same name are not the toolkit's

use optix_device_rs::prelude::*;

pub struct Triangles;

#[closesthit]
pub fn shade<P: Pipeline>(_: &ClosestHit<P, Triangles>) {}

fn main() {}
