// I003: a reference has the signature of its callable

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Paint {
    pub texture: Callable<fn(Vec2, u32) -> Vec3>,
}

fn look<P>(hit: &ClosestHit<P, Triangles>, texture: Callable<fn(Vec2) -> Vec3>) -> Vec3 {
    texture.call(hit, Vec2::X)
}

#[closesthit]
pub fn program<P: Pipeline>(hit: &ClosestHit<P, Triangles>, record: &Paint) {
    let _ = look(hit, record.texture);
}

fn main() {}
