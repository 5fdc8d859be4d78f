// G054: hits of an intersection program are not declared triangles

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Attributes)]
pub struct BallHit {
    pub at: Vec2,
}

impl optix_device_rs::primitive::OnTriangles for BallHit {}

#[closesthit]
fn shade<P: Pipeline>(hit: &ClosestHit<P, BallHit>) {
    let _ = hit.barycentrics();
}

fn main() {}
