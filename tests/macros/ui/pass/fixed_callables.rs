//! The cases about callables, put right: one module each, with the name of the case.
#![allow(dead_code, unused)]

#[path = "../common/mod.rs"]
mod common;

mod callable_argument_missing {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Paint {
        pub texture: Callable<fn(Vec2, u32) -> Vec3>,
    }

    #[closesthit]
    pub fn program<P: Pipeline>(hit: &ClosestHit<P, Triangles>, record: &Paint) {
        let _ = record.texture.call(hit, Vec2::X, 1);
    }
}

mod callable_argument_of_another_type {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Paint {
        pub texture: Callable<fn(Vec2, u32) -> Vec3>,
    }

    #[closesthit]
    pub fn program<P: Pipeline>(hit: &ClosestHit<P, Triangles>, record: &Paint) {
        let _ = record.texture.call(hit, Vec2::X, 1);
    }
}

mod callable_call_without_context {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Paint {
        pub texture: Callable<fn(Vec2, u32) -> Vec3>,
    }

    #[closesthit]
    pub fn program<P: Pipeline>(hit: &ClosestHit<P, Triangles>, record: &Paint) {
        let _ = record.texture.call(hit, Vec2::X, 1);
    }
}

mod callable_forged {
    use optix_device_rs::prelude::*;

    pub fn texture(textures: Callables<fn(Vec2) -> Vec3>) -> Callable<fn(Vec2) -> Vec3> {
        textures.get(7)
    }
}

mod callable_of_another_kind {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Paint {
        pub texture: Callable<fn(Vec2, u32) -> Vec3>,
    }

    fn look<P>(hit: &ClosestHit<P, Triangles>, texture: Callable<fn(Vec2, u32) -> Vec3>) -> Vec3 {
        texture.call(hit, Vec2::X, 1)
    }

    #[closesthit]
    pub fn program<P: Pipeline>(hit: &ClosestHit<P, Triangles>, record: &Paint) {
        let _ = look(hit, record.texture);
    }
}

mod callable_of_another_signature {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Paint {
        pub texture: Callable<fn(Vec2, u32) -> Vec3>,
    }

    fn look<P>(hit: &ClosestHit<P, Triangles>, texture: Callable<fn(Vec2, u32) -> Vec3>) -> Vec3 {
        texture.call(hit, Vec2::X, 1)
    }

    #[closesthit]
    pub fn program<P: Pipeline>(hit: &ClosestHit<P, Triangles>, record: &Paint) {
        let _ = look(hit, record.texture);
    }
}

mod callable_result_of_another_type {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Paint {
        pub texture: Callable<fn(Vec2, u32) -> Vec3>,
    }

    #[closesthit]
    pub fn program<P: Pipeline>(hit: &ClosestHit<P, Triangles>, record: &Paint) {
        let _: Vec3 = record.texture.call(hit, Vec2::X, 1);
    }
}

mod callable_signature_by_reference {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Paint {
        pub texture: Callable<fn(Vec2) -> Vec3>,
    }
}

mod callable_signature_is_no_function {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Paint {
        pub texture: Callable<fn() -> Vec3>,
    }
}

mod device_helper_of_a_direct_callable_traces {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Shadow {
        #[payload(write(caller, miss), read(caller))]
        pub visible: bool,
    }

    fn visible<P: HasRay<Shadow>>(cc: &ContinuationCallable<P>) -> bool {
        cc.trace::<Shadow>(Traversable::NULL, Ray::new(Vec3::ZERO, Vec3::X), ShadowFromCaller { visible: false }).visible
    }

    #[continuation_callable]
    pub fn program<P: HasRay<Shadow>>(cc: &ContinuationCallable<P>) -> f32 {
        if visible(cc) { 1.0 } else { 0.0 }
    }
}

mod payload_function_pointer {
    use optix_device_rs::prelude::*;

    #[derive(Payload)]
    pub struct Radiance {
        #[payload(write(caller), read(closesthit))]
        pub texture: Callable<fn(Vec2) -> Vec3>,
    }
}

mod pipeline_callable_depth {
    use crate::common::*;

    #[direct_callable]
    fn wood<P: Pipeline>(_: &DirectCallable<P>, uv: Vec2) -> Vec3 {
        uv.extend(0.0)
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
            direct_callables: [wood],
            callable_depth: 2,
        }
    }
}

mod pipeline_callable_of_another_kind {
    use crate::common::*;

    #[direct_callable]
    fn wood<P: Pipeline>(_: &DirectCallable<P>, uv: Vec2) -> Vec3 {
        uv.extend(0.0)
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
            direct_callables: [wood],
        }
    }
}

mod pipeline_callable_traces_a_foreign_ray {
    use crate::common::*;

    #[continuation_callable]
    fn mirror<P: HasRay<Radiance>>(cc: &ContinuationCallable<P>) -> f32 {
        let ray = Ray::new(Vec3::ZERO, Vec3::X);
        cc.trace::<Radiance>(Traversable::NULL, ray, ()).light.x
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
            continuation_callables: [mirror],
        }
    }
}

mod pipeline_callable_twice {
    use crate::common::*;

    #[direct_callable]
    fn wood<P: Pipeline>(_: &DirectCallable<P>, uv: Vec2) -> Vec3 {
        uv.extend(0.0)
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
            direct_callables: [wood],
        }
    }
}

mod pipeline_callable_without_attribute {
    use crate::common::*;

    #[direct_callable]
    fn wood<P: Pipeline>(_: &DirectCallable<P>, uv: Vec2) -> Vec3 {
        uv.extend(0.0)
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
            direct_callables: [wood],
        }
    }
}

mod pipeline_callable_words {
    use crate::common::*;

    #[direct_callable]
    fn wood<P: Pipeline>(_: &DirectCallable<P>, at: [Vec4; 8]) -> Vec4 {
        at[0]
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
            direct_callables: [wood],
        }
    }
}

mod pipeline_callables_without_brackets {
    use crate::common::*;

    #[direct_callable]
    fn wood<P: Pipeline>(_: &DirectCallable<P>, uv: Vec2) -> Vec3 {
        uv.extend(0.0)
    }

    pipeline! {
        pub struct PathTracer {
            params: Frame,
            raygen: [camera],
            rays: { Radiance { miss: sky }, Shadow { miss: lit } },
            hitgroups: { Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} } },
            direct_callables: [wood],
        }
    }
}

mod program_callable_argument_not_words {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, Words)]
    pub struct Noise {
        pub scale: f32,
    }

    #[direct_callable]
    fn wood<P: Pipeline>(_: &DirectCallable<P>, uv: Vec2, noise: Noise) -> Vec2 {
        uv * noise.scale
    }
}

mod program_callable_changes_an_argument {
    use optix_device_rs::prelude::*;

    #[direct_callable]
    fn wood<P: Pipeline>(_: &DirectCallable<P>, colour: Vec3) -> Vec3 {
        colour.with_x(1.0)
    }
}

mod program_callable_generic_argument {
    use optix_device_rs::prelude::*;

    #[direct_callable]
    fn wood<P: Pipeline>(_: &DirectCallable<P>, of: f32) -> f32 {
        of
    }
}

mod program_callable_never_returns {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, UserException)]
    pub enum Fault {
        Lost,
    }

    #[direct_callable]
    fn wood<P: Throws<Fault>>(dc: &DirectCallable<P>) {
        dc.throw(Fault::Lost)
    }
}

mod program_callable_of_another_context {
    use optix_device_rs::prelude::*;

    #[continuation_callable]
    fn wood<P: Pipeline>(_: &ContinuationCallable<P>) -> f32 {
        1.0
    }
}

mod program_callable_record_last {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Wood {
        pub colour: Vec3,
    }

    #[direct_callable]
    fn wood<P: Pipeline>(_: &DirectCallable<P>, record: &Wood, share: f32) -> Vec3 {
        record.colour * share
    }
}

mod program_callable_record_not_a_record {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Wood {
        pub colour: Vec3,
    }

    #[direct_callable]
    fn wood<P: Pipeline>(_: &DirectCallable<P>, record: &Wood) -> Vec3 {
        record.colour
    }
}

mod program_callable_result_not_words {
    use optix_device_rs::prelude::*;

    #[direct_callable]
    fn wood<P: Pipeline>(_: &DirectCallable<P>) -> u32 {
        7
    }

    #[direct_callable]
    fn stone<P: Pipeline>(_: &DirectCallable<P>) -> Option<f32> {
        Some(1.0)
    }
}

mod program_callable_takes_a_function {
    use optix_device_rs::prelude::*;

    #[direct_callable]
    fn wood<P: Pipeline>(dc: &DirectCallable<P>, uv: Vec2, noise: Callable<fn(Vec2) -> f32>) -> f32 {
        noise.call(dc, uv)
    }
}

mod program_callable_takes_a_reference {
    use optix_device_rs::prelude::*;

    #[direct_callable]
    fn wood<P: Pipeline>(_: &DirectCallable<P>, uv: Vec2, at: Vec3) -> Vec3 {
        uv.extend(at.z)
    }
}

mod program_callable_too_many_arguments {
    use optix_device_rs::prelude::*;

    #[direct_callable]
    fn wood<P: Pipeline>(_: &DirectCallable<P>, a: [u8; 9]) -> u8 {
        a[0]
    }
}

mod record_function_pointer {
    use optix_device_rs::prelude::*;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Paint {
        pub texture: Callable<fn(Vec2) -> Vec3>,
    }
}

mod callable_signature_by_hand {
    use optix_device_rs::prelude::*;

    pub type Texture = fn(Vec2) -> Vec3;

    #[derive(Clone, Copy, SbtRecord)]
    #[repr(C)]
    pub struct Paint {
        pub texture: Callable<fn(Vec2) -> Vec3, Continuation>,
    }
}

fn main() {}
