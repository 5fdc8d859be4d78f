// C050, G054: an intersection program does not report hits on triangles

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Ball {
    pub radius: f32,
}

#[intersection]
fn ball<P: Pipeline>(isect: &Intersection<P, Triangles>, record: &Ball) {
    isect.report(record.radius, 0, Triangles { u: 0.25, v: 0.25 });
}

fn main() {}
