// I002, I005: a call passes the context of the program that calls

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Paint {
    pub texture: Callable<fn(Vec2, u32) -> Vec3>,
}

#[closesthit]
pub fn program<P: Pipeline>(hit: &ClosestHit<P, Triangles>, record: &Paint) {
    let _ = record.texture.call(record, Vec2::X, 1);
}

fn main() {}
