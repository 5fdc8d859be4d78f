// G005, H007, I006: an intersection program calls no function that is another's
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

#[intersection]
pub fn program<P: HasRay<Shadow> + Throws<Fault>>(at: &Intersection<P, BallHit>) {
    let _ = at.trace::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false });
    let _ = at.trace_without_closesthit::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false });
    let _ = continuation().call(at, 1);
    let _ = at.hit_kind();
    let _ = at.primitive_type();
    let _ = at.face();
    let _ = at.hit_kind().is_triangle();
    let _ = at.barycentrics();
    let _ = at.attributes();
    let _ = at.vertices();
    let _ = at.exception_code();
    let _ = at.line_info();
    let _ = at.raised();
}

fn main() {}
