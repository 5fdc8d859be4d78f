// G005, G014, G029, G040: a raygen program calls no function that is another's
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

#[raygen]
pub fn program<P: HasRay<Shadow> + Throws<Fault>>(at: &RayGen<P>) {
    let _ = at.world_ray_origin();
    let _ = at.world_ray_direction();
    let _ = at.ray_tmin();
    let _ = at.ray_tmax();
    let _ = at.ray_time();
    let _ = at.ray_flags();
    let _ = at.ray_visibility_mask();
    let _ = at.object_ray_origin();
    let _ = at.object_ray_direction();
    let _ = at.gas_handle();
    let _ = at.primitive_index();
    let _ = at.sbt_gas_index();
    let _ = at.instance_id();
    let _ = at.instance_index();
    let _ = at.transform_list_size();
    let _ = at.transform_list_handle(0);
    let _ = at.world_to_object();
    let _ = at.object_to_world();
    let _ = at.point_to_object(Vec3::X);
    let _ = at.vector_to_object(Vec3::X);
    let _ = at.normal_to_object(Vec3::X);
    let _ = at.point_to_world(Vec3::X);
    let _ = at.vector_to_world(Vec3::X);
    let _ = at.normal_to_world(Vec3::X);
    let _ = at.hit_kind();
    let _ = at.primitive_type();
    let _ = at.face();
    let _ = at.hit_kind().is_triangle();
    let _ = at.barycentrics();
    let _ = at.attributes();
    let _ = at.vertices();
    let _ = at.report(1.0, 0, BallHit { uv: Vec2::ZERO });
    let _ = at.exception_code();
    let _ = at.line_info();
    let _ = at.raised();
}

fn main() {}
