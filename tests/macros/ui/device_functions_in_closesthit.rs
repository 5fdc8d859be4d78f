// G005, G029, G040: a closesthit program calls no function that is another's
// Made from `device_functions.tsv`.

use optix_device_rs::callable::Continuation;
use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Shadow {
    #[payload(write(caller, miss), read(caller))]
    pub visible: bool,
}

#[derive(Clone, Copy, Attributes)]
pub struct BallHit {
    pub uv: Vec2,
}

#[derive(Clone, Copy, UserException)]
pub enum Fault {
    Lost,
}

pub fn instances() -> Instances {
    unreachable!()
}

pub fn triangles() -> TriangleVertices {
    unreachable!()
}

pub fn direct() -> Callable<fn(u32) -> u32> {
    unreachable!()
}

pub fn continuation() -> Callable<fn(u32) -> u32, Continuation> {
    unreachable!()
}

#[closesthit]
pub fn program<P: HasRay<Shadow> + Throws<Fault>>(at: &ClosestHit<P, Triangles>) {
    let _ = at.object_ray_origin();
    let _ = at.object_ray_direction();
    let _ = at.report(1.0, 0, BallHit { uv: Vec2::ZERO });
    let _ = at.exception_code();
    let _ = at.line_info();
    let _ = at.raised();
}

fn main() {}
