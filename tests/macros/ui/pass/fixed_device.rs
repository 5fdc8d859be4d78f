//! The cases about device functions, put right: one module each, with the name of the case.
#![allow(dead_code, unused)]

mod device_anyhit_flags_together {
    use optix_device_rs::prelude::*;

    pub fn flags() -> RayFlags {
        RayFlags::NONE.any_hit(AnyHitMode::Disable)
    }
}

mod device_barycentrics_of_a_ball {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Attributes)]
    pub struct BallHit {
        pub normal: Vec3,
    }

    #[closesthit]
    pub fn shade<P: Pipeline>(hit: &ClosestHit<P, Triangles>) {
        let _ = hit.barycentrics();
        let _ = hit.face();
        let _ = hit.vertices();
        let _ = hit.surface_point();
    }
}

mod device_barycentrics_of_any_hit {
    use optix_device_rs::prelude::*;

    #[anyhit]
    pub fn cut_out<P: Pipeline>(hit: &AnyHit<P, Triangles>) -> Decision {
        if hit.barycentrics().x > 0.5 { Decision::Ignore } else { Decision::Accept }
    }
}

mod device_flag_disables_closesthit {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Shadow {
        #[payload(write(caller, miss), read(caller))]
        pub visible: bool,
    }

    pub fn visible<P: HasRay<Shadow>>(rg: &RayGen<P>, world: Traversable, ray: Ray) -> bool {
        let ray = ray.flags(RayFlags::NONE.terminate_on_first_hit());
        rg.trace_without_closesthit::<Shadow>(world, ray, ShadowFromCaller { visible: false }).visible
    }
}

mod device_cull_flags_together {
    use optix_device_rs::prelude::*;

    pub fn flags() -> RayFlags {
        RayFlags::NONE.cull(CullFaces::Back)
    }
}

mod device_data_without_repr_c {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, DeviceData)]
    #[repr(C)]
    pub struct Pinhole {
        pub eye: Vec3,
    }
}

mod device_decision_by_call {
    use optix_device_rs::prelude::*;

    #[anyhit]
    pub fn program<P: Pipeline>(at: &AnyHit<P, Triangles>) -> Decision {
        if at.hit_kind() == HitKind::TRIANGLE_FRONT_FACE {
            return Decision::Ignore;
        }
        Decision::Terminate
    }
}

mod device_helper_of_another_context {
    use optix_device_rs::prelude::*;

    fn side<P>(ms: &Miss<P>) -> bool {
        ms.world_ray_direction().x > 0.0
    }

    #[miss]
    pub fn sky<P: Pipeline>(ms: &Miss<P>) {
        let _ = side(ms);
    }
}

mod device_instance_id_is_optional {
    use optix_device_rs::prelude::*;

    #[closesthit]
    pub fn shade<P: Pipeline>(hit: &ClosestHit<P, Triangles>) {
        let _table = [0; 4][hit.instance_id().unwrap_or(0) as usize];
    }
}

mod device_trace_in_a_helper {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Shadow {
        #[payload(write(caller, miss), read(caller))]
        pub visible: bool,
    }

    fn occluded<P: HasRay<Shadow>, A>(hit: &ClosestHit<P, A>) -> bool {
        !hit.trace::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false })
            .visible
    }

    #[closesthit]
    pub fn program<P: HasRay<Shadow>>(hit: &ClosestHit<P, Triangles>) {
        let _ = occluded(hit);
    }
}

mod device_wide_kind {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Attributes)]
    pub struct BallHit {
        pub normal: Vec3,
    }

    #[intersection]
    pub fn ball<P: Pipeline>(isect: &Intersection<P, BallHit>) {
        isect.report(1.0, 0x7f, BallHit { normal: Vec3::X });
    }
}

mod device_wide_mask {
    use optix_device_rs::prelude::*;

    pub fn ray() -> Ray {
        Ray::new(Vec3::ZERO, Vec3::X).mask(0x80)
    }
}

mod device_writes_a_slice {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub table: SliceMut<u32>,
    }

    #[raygen]
    pub fn camera<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
        rg.params().table().set(0, 3);
    }
}

mod device_writes_params {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub count: u32,
        pub counts: SliceMut<u32>,
    }

    #[raygen]
    pub fn camera<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
        rg.params().counts().set(0, 3);
    }
}

mod device_instances_without_context {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub lamps: Instances,
    }

    #[raygen]
    pub fn camera<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
        let _ = rg.params().lamps().get(rg, 0).id();
    }
}

mod device_instances_of_a_traversable {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub world: Traversable,
        pub lamps: Instances,
    }

    #[raygen]
    pub fn camera<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
        let _ = rg.params().lamps().get(rg, 0).id();
    }
}

mod device_instances_forged {
    use optix_device_rs::prelude::*;

    pub fn of(lamps: Instances) -> Instances {
        lamps
    }
}

mod device_triangles_by_hit_handle {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub bulb: TriangleVertices,
    }

    #[closesthit]
    pub fn shade<P: Pipeline<Params = Frame>>(hit: &ClosestHit<P, Triangles>) {
        let _ = hit.params().bulb().get(hit, hit.sbt_gas_index(), hit.primitive_index() + 1);
    }
}

mod device_triangle_of_no_record {
    use optix_device_rs::prelude::*;

    #[launch_params]
    pub struct Frame {
        pub bulb: TriangleVertices,
    }

    #[raygen]
    pub fn camera<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
        let [_, _, _] = rg.params().bulb().get(rg, 0, 7);
    }
}

mod device_forged_context {
    use optix_device_rs::prelude::*;

    pub struct Both<'a, P>(&'a DirectCallable<P>);

    pub fn id<P>(both: Both<'_, P>, lamps: Instances) -> u32 {
        lamps.get(both.0, 0).id()
    }
}

mod device_instance_outlives_its_program {
    use optix_device_rs::prelude::*;

    pub fn first<'a, P>(rg: &'a RayGen<P>, lamps: Instances) -> InstanceHandle<'a> {
        lamps.get(rg, 0)
    }
}

mod device_flags_by_bits {
    use optix_device_rs::prelude::*;

    pub fn flags() -> RayFlags {
        RayFlags::NONE.any_hit(AnyHitMode::Disable).cull(CullFaces::Back)
    }
}

fn main() {}
