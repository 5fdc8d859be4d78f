//! G005: every device function from every kind of program that may call it; made from `device_functions.tsv`.
#![deny(warnings)]

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

mod device_functions_in_raygen {
    use super::*;

    #[raygen]
    pub fn program<P: HasRay<Shadow> + Throws<Fault>>(at: &RayGen<P>) {
        let _ = at.launch_index();
        let _ = at.launch_dimensions();
        let _ = None::<TransformHandle>.map(TransformHandle::transform_type);
        let _ = None::<InstanceHandle>.map(InstanceHandle::child);
        let _ = None::<InstanceHandle>.map(InstanceHandle::id);
        let _ = None::<InstanceHandle>.map(InstanceHandle::transform);
        let _ = None::<InstanceHandle>.map(InstanceHandle::inverse_transform);
        let _ = instances().get(at, 0);
        let _ = HitKind::TRIANGLE_BACK_FACE.primitive_type();
        let _ = HitKind::TRIANGLE_BACK_FACE.face();
        let _ = triangles().get(at, 0, 0);
        let _ = || at.throw(Fault::Lost);
        let _ = direct().call(at, 1);
        let _ = at.trace::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false });
        let _ = at.trace_without_closesthit::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false });
        let _ = continuation().call(at, 1);
    }
}

mod device_functions_in_intersection {
    use super::*;

    #[intersection]
    pub fn program<P: HasRay<Shadow> + Throws<Fault>>(at: &Intersection<P, BallHit>) {
        let _ = at.launch_index();
        let _ = at.launch_dimensions();
        let _ = None::<TransformHandle>.map(TransformHandle::transform_type);
        let _ = None::<InstanceHandle>.map(InstanceHandle::child);
        let _ = None::<InstanceHandle>.map(InstanceHandle::id);
        let _ = None::<InstanceHandle>.map(InstanceHandle::transform);
        let _ = None::<InstanceHandle>.map(InstanceHandle::inverse_transform);
        let _ = instances().get(at, 0);
        let _ = HitKind::TRIANGLE_BACK_FACE.primitive_type();
        let _ = HitKind::TRIANGLE_BACK_FACE.face();
        let _ = triangles().get(at, 0, 0);
        let _ = || at.throw(Fault::Lost);
        let _ = direct().call(at, 1);
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
        let _ = at.report(1.0, 0, BallHit { uv: Vec2::ZERO });
    }
}

mod device_functions_in_anyhit {
    use super::*;

    #[anyhit]
    pub fn program<P: HasRay<Shadow> + Throws<Fault>>(at: &AnyHit<P, Triangles>) -> Decision {
        let _ = at.launch_index();
        let _ = at.launch_dimensions();
        let _ = None::<TransformHandle>.map(TransformHandle::transform_type);
        let _ = None::<InstanceHandle>.map(InstanceHandle::child);
        let _ = None::<InstanceHandle>.map(InstanceHandle::id);
        let _ = None::<InstanceHandle>.map(InstanceHandle::transform);
        let _ = None::<InstanceHandle>.map(InstanceHandle::inverse_transform);
        let _ = instances().get(at, 0);
        let _ = HitKind::TRIANGLE_BACK_FACE.primitive_type();
        let _ = HitKind::TRIANGLE_BACK_FACE.face();
        let _ = triangles().get(at, 0, 0);
        let _ = || at.throw(Fault::Lost);
        let _ = direct().call(at, 1);
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
        Decision::Accept
    }
}

mod device_functions_in_closesthit {
    use super::*;

    #[closesthit]
    pub fn program<P: HasRay<Shadow> + Throws<Fault>>(at: &ClosestHit<P, Triangles>) {
        let _ = at.launch_index();
        let _ = at.launch_dimensions();
        let _ = None::<TransformHandle>.map(TransformHandle::transform_type);
        let _ = None::<InstanceHandle>.map(InstanceHandle::child);
        let _ = None::<InstanceHandle>.map(InstanceHandle::id);
        let _ = None::<InstanceHandle>.map(InstanceHandle::transform);
        let _ = None::<InstanceHandle>.map(InstanceHandle::inverse_transform);
        let _ = instances().get(at, 0);
        let _ = HitKind::TRIANGLE_BACK_FACE.primitive_type();
        let _ = HitKind::TRIANGLE_BACK_FACE.face();
        let _ = triangles().get(at, 0, 0);
        let _ = || at.throw(Fault::Lost);
        let _ = direct().call(at, 1);
        let _ = at.trace::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false });
        let _ = at.trace_without_closesthit::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false });
        let _ = continuation().call(at, 1);
        let _ = at.world_ray_origin();
        let _ = at.world_ray_direction();
        let _ = at.ray_tmin();
        let _ = at.ray_tmax();
        let _ = at.ray_time();
        let _ = at.ray_flags();
        let _ = at.ray_visibility_mask();
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
    }
}

mod device_functions_in_miss {
    use super::*;

    #[miss]
    pub fn program<P: HasRay<Shadow> + Throws<Fault>>(at: &Miss<P>) {
        let _ = at.launch_index();
        let _ = at.launch_dimensions();
        let _ = None::<TransformHandle>.map(TransformHandle::transform_type);
        let _ = None::<InstanceHandle>.map(InstanceHandle::child);
        let _ = None::<InstanceHandle>.map(InstanceHandle::id);
        let _ = None::<InstanceHandle>.map(InstanceHandle::transform);
        let _ = None::<InstanceHandle>.map(InstanceHandle::inverse_transform);
        let _ = instances().get(at, 0);
        let _ = HitKind::TRIANGLE_BACK_FACE.primitive_type();
        let _ = HitKind::TRIANGLE_BACK_FACE.face();
        let _ = triangles().get(at, 0, 0);
        let _ = || at.throw(Fault::Lost);
        let _ = direct().call(at, 1);
        let _ = at.trace::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false });
        let _ = at.trace_without_closesthit::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false });
        let _ = continuation().call(at, 1);
        let _ = at.world_ray_origin();
        let _ = at.world_ray_direction();
        let _ = at.ray_tmin();
        let _ = at.ray_tmax();
        let _ = at.ray_time();
        let _ = at.ray_flags();
        let _ = at.ray_visibility_mask();
    }
}

mod device_functions_in_exception {
    use super::*;

    #[exception]
    pub fn program<P: HasRay<Shadow> + Pipeline<Exception = Fault>>(at: &Exception<P>) {
        let _ = at.launch_index();
        let _ = at.launch_dimensions();
        let _ = None::<TransformHandle>.map(TransformHandle::transform_type);
        let _ = None::<InstanceHandle>.map(InstanceHandle::child);
        let _ = None::<InstanceHandle>.map(InstanceHandle::id);
        let _ = None::<InstanceHandle>.map(InstanceHandle::transform);
        let _ = None::<InstanceHandle>.map(InstanceHandle::inverse_transform);
        let _ = instances().get(at, 0);
        let _ = HitKind::TRIANGLE_BACK_FACE.primitive_type();
        let _ = HitKind::TRIANGLE_BACK_FACE.face();
        let _ = triangles().get(at, 0, 0);
        let _ = at.exception_code();
        let _ = at.line_info();
        let _ = at.raised();
    }
}

mod device_functions_in_direct_callable {
    use super::*;

    #[direct_callable]
    pub fn program<P: HasRay<Shadow> + Throws<Fault>>(at: &DirectCallable<P>) {
        let _ = at.launch_index();
        let _ = at.launch_dimensions();
        let _ = None::<TransformHandle>.map(TransformHandle::transform_type);
        let _ = None::<InstanceHandle>.map(InstanceHandle::child);
        let _ = None::<InstanceHandle>.map(InstanceHandle::id);
        let _ = None::<InstanceHandle>.map(InstanceHandle::transform);
        let _ = None::<InstanceHandle>.map(InstanceHandle::inverse_transform);
        let _ = instances().get(at, 0);
        let _ = HitKind::TRIANGLE_BACK_FACE.primitive_type();
        let _ = HitKind::TRIANGLE_BACK_FACE.face();
        let _ = triangles().get(at, 0, 0);
        let _ = || at.throw(Fault::Lost);
        let _ = direct().call(at, 1);
    }
}

mod device_functions_in_continuation_callable {
    use super::*;

    #[continuation_callable]
    pub fn program<P: HasRay<Shadow> + Throws<Fault>>(at: &ContinuationCallable<P>) {
        let _ = at.launch_index();
        let _ = at.launch_dimensions();
        let _ = None::<TransformHandle>.map(TransformHandle::transform_type);
        let _ = None::<InstanceHandle>.map(InstanceHandle::child);
        let _ = None::<InstanceHandle>.map(InstanceHandle::id);
        let _ = None::<InstanceHandle>.map(InstanceHandle::transform);
        let _ = None::<InstanceHandle>.map(InstanceHandle::inverse_transform);
        let _ = instances().get(at, 0);
        let _ = HitKind::TRIANGLE_BACK_FACE.primitive_type();
        let _ = HitKind::TRIANGLE_BACK_FACE.face();
        let _ = triangles().get(at, 0, 0);
        let _ = || at.throw(Fault::Lost);
        let _ = direct().call(at, 1);
        let _ = at.trace::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false });
        let _ = at.trace_without_closesthit::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false });
        let _ = continuation().call(at, 1);
    }
}

fn main() {}
