//! G005: every device function from every kind of program that may call it.
#![deny(warnings)]

use optix_device_rs::prelude::*;

#[derive(Payload)]
pub struct Shadow {
    #[payload(write(caller, miss), read(caller))]
    pub visible: bool,
}

#[raygen]
pub fn raygen_program<P: HasRay<Shadow>>(at: &RayGen<P>) {
    let _ = at.launch_index();
    let _ = at.launch_dimensions();
    let _ = at.trace::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false });
}

#[intersection]
pub fn intersection_program<P: HasRay<Shadow>>(at: &Intersection<P, Triangles>) {
    let _ = at.launch_index();
    let _ = at.launch_dimensions();
    let _ = at.world_ray_origin();
    let _ = at.world_ray_direction();
    let _ = at.ray_tmin();
    let _ = at.ray_tmax();
    let _ = at.ray_time();
    let _ = at.ray_flags();
    let _ = at.ray_visibility_mask();
    let _ = at.object_ray_origin();
    let _ = at.object_ray_direction();
    let _ = at.primitive_index();
    let _ = at.sbt_gas_index();
    let _ = at.instance_id();
    let _ = at.instance_index();
    let _ = at.world_to_object();
    let _ = at.object_to_world();
    let _ = at.report(1.0, 0, Triangles { u: 0.0, v: 0.0 });
}

#[anyhit]
pub fn anyhit_program<P: HasRay<Shadow>>(at: &AnyHit<P, Triangles>) -> Decision {
    let _ = at.launch_index();
    let _ = at.launch_dimensions();
    let _ = at.world_ray_origin();
    let _ = at.world_ray_direction();
    let _ = at.ray_tmin();
    let _ = at.ray_tmax();
    let _ = at.ray_time();
    let _ = at.ray_flags();
    let _ = at.ray_visibility_mask();
    let _ = at.object_ray_origin();
    let _ = at.object_ray_direction();
    let _ = at.primitive_index();
    let _ = at.sbt_gas_index();
    let _ = at.instance_id();
    let _ = at.instance_index();
    let _ = at.world_to_object();
    let _ = at.object_to_world();
    let _ = at.hit_kind();
    let _ = at.face();
    let _ = at.barycentrics();
    let _ = at.attributes();
    let _ = at.vertices();
    Decision::Accept
}

#[closesthit]
pub fn closesthit_program<P: HasRay<Shadow>>(at: &ClosestHit<P, Triangles>) {
    let _ = at.launch_index();
    let _ = at.launch_dimensions();
    let _ = at.trace::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false });
    let _ = at.world_ray_origin();
    let _ = at.world_ray_direction();
    let _ = at.ray_tmin();
    let _ = at.ray_tmax();
    let _ = at.ray_time();
    let _ = at.ray_flags();
    let _ = at.ray_visibility_mask();
    let _ = at.primitive_index();
    let _ = at.sbt_gas_index();
    let _ = at.instance_id();
    let _ = at.instance_index();
    let _ = at.world_to_object();
    let _ = at.object_to_world();
    let _ = at.hit_kind();
    let _ = at.face();
    let _ = at.barycentrics();
    let _ = at.attributes();
    let _ = at.vertices();
}

#[miss]
pub fn miss_program<P: HasRay<Shadow>>(at: &Miss<P>) {
    let _ = at.launch_index();
    let _ = at.launch_dimensions();
    let _ = at.trace::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false });
    let _ = at.world_ray_origin();
    let _ = at.world_ray_direction();
    let _ = at.ray_tmin();
    let _ = at.ray_tmax();
    let _ = at.ray_time();
    let _ = at.ray_flags();
    let _ = at.ray_visibility_mask();
}

fn main() {}
