// I002, I006: a reference has the kind of its callable

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Paint {
    pub texture: Callable<fn(Vec2, u32) -> Vec3>,
}

fn look<P>(hit: &ClosestHit<P, Triangles>, texture: Callable<fn(Vec2, u32) -> Vec3, Continuation>) -> Vec3 {
    texture.call(hit, Vec2::X, 1)
}

#[closesthit]
pub fn program<P: Pipeline>(hit: &ClosestHit<P, Triangles>, record: &Paint) {
    let _ = look(hit, record.texture);
}

fn main() {}
