// G054: barycentrics, face and vertices are of triangles

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Attributes)]
pub struct BallHit {
    pub normal: Vec3,
}

#[closesthit]
pub fn shade<P: Pipeline>(hit: &ClosestHit<P, BallHit>) {
    let _ = hit.barycentrics();
    let _ = hit.face();
    let _ = hit.vertices();
    let _ = hit.surface_point();
}

fn main() {}
