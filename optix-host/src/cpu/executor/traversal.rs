//! Runs the programs that are called during the traversal of a ray, and answers what programs at a primitive ask.

use super::call::{Call, RayAndHit};
use super::checks;
use super::handle::{self, rows};
use crate::cpu::traversal::{self, Candidate, InstancePath, PrimitiveContext, Programs, Reporter};
use core::cell::RefCell;
use glam::Vec3;
use optix_device_rs::host::{CallableCall, Executor, HitState, InstanceState, TraceCall, no_answer};
use optix_device_rs::prelude::{Decision, Ray};
use optix_device_rs::words::WordBuffer;

/// Closest-hit and any-hit programs, which run at a primitive. `V` finds the vertices of its triangle.
pub(super) struct AtHit<'c, V> {
    pub call: &'c Call<'c>,
    pub path: &'c InstancePath<'c>,
    pub vertices: V,
}

/// Answers of programs at a primitive: about the path to it, and those that programs without a primitive get too.
macro_rules! of_path {
    () => {
        fn trace(&self, call: &TraceCall, payload: &mut WordBuffer) {
            self.call.trace(call, payload);
        }
        fn call(&self, call: &CallableCall, words: &mut WordBuffer) {
            self.call.call(call, words);
        }
        fn object_to_world(&self) -> [[f32; 4]; 3] {
            rows(self.path.object_to_world())
        }
        fn world_to_object(&self) -> [[f32; 4]; 3] {
            rows(self.path.world_to_object())
        }
        fn gas_traversable_handle(&self) -> u64 {
            handle::of(self.path.leaf())
        }
        fn transform_list_size(&self) -> u32 {
            self.path.indices().len() as u32
        }
        fn transform_list_handle(&self, index: u32) -> u64 {
            self.path.instances().nth(index as usize).map_or(0, handle::of)
        }
        unsafe fn instance_traversable_from_ias(&self, ias: u64, index: u32) -> u64 {
            // SAFETY: the caller's.
            unsafe { self.call.instance_traversable_from_ias(ias, index) }
        }
        unsafe fn instance(&self, handle: u64) -> InstanceState {
            // SAFETY: the caller's.
            unsafe { self.call.instance(handle) }
        }
        unsafe fn triangle_vertices_from_handle(&self, gas: u64, primitive: u32, sbt_gas_index: u32) -> [Vec3; 3] {
            // SAFETY: the caller's.
            unsafe { self.call.triangle_vertices_from_handle(gas, primitive, sbt_gas_index) }
        }
    };
}

impl<V: Fn() -> Option<[[f32; 3]; 3]>> Executor for AtHit<'_, V> {
    of_path!();

    fn triangle_vertices(&self) -> [Vec3; 3] {
        match (self.vertices)() {
            Some(vertices) => vertices.map(Vec3::from_array),
            None => no_answer("vertices"),
        }
    }
}

/// An intersection program, which runs at its primitive.
struct AtPrimitive<'c, 't, 'p, 'r, 's> {
    call: &'c Call<'c>,
    path: &'c InstancePath<'c>,
    context: &'c PrimitiveContext<'c>,
    traversal: RefCell<&'t mut Traversal<'p>>,
    reporter: RefCell<&'t mut Reporter<'r, 's>>,
}

impl Executor for AtPrimitive<'_, '_, '_, '_, '_> {
    of_path!();

    fn report(&self, t: f32, kind: u8, count: usize, attributes: &WordBuffer) -> bool {
        if self.call.launch.checked {
            checks::report(self.context, self.interval_end(), t, kind);
        }
        // As on the device: OptiX keeps seven bits of the kind, and the eighth tells that the primitive is a built-in
        // one.
        let kind = kind & 0x7f;
        // The any-hit program that this may call gets executors of its own, so neither cell is borrowed twice.
        self.reporter.borrow_mut().report(&mut **self.traversal.borrow_mut(), t, kind, &attributes.0[..count])
    }
    fn interval_end(&self) -> f32 {
        self.reporter.borrow().tmax()
    }
}

/// The programs that run while a ray is traversed.
pub(super) struct Traversal<'c> {
    pub call: Call<'c>,
    pub ray: Ray,
}

/// What a program at a primitive sees. `ray` has the `tmax` for that program.
fn ray_and_hit(context: &PrimitiveContext<'_>, ray: Ray, kind: u8, attributes: [u32; 8]) -> RayAndHit {
    RayAndHit {
        ray,
        object_ray: (Vec3::from_array(context.object_ray.origin), Vec3::from_array(context.object_ray.direction)),
        hit: HitState {
            primitive_index: context.primitive_index,
            sbt_gas_index: context.sbt_gas_index,
            instance_id: context.path.instance_id(),
            instance_index: context.path.instance_index(),
            kind,
            attributes,
        },
    }
}

impl Programs for Traversal<'_> {
    fn any_hit(&mut self, candidate: &Candidate<'_>) -> traversal::AnyHit {
        let (call, context) = (&self.call, &candidate.context);
        let Some(entry) = &call.hit_programs(context.sbt_index).anyhit else { return traversal::AnyHit::Accept };
        let executor = AtHit { call, path: context.path, vertices: || candidate.triangle_vertices() };
        let ray = Ray { tmax: candidate.t, ..self.ray };
        let ray_and_hit = ray_and_hit(context, ray, candidate.hit_kind, candidate.attributes);
        match call.run(entry, &call.launch.sbt.hit, context.sbt_index as usize, ray_and_hit, &executor) {
            Decision::Accept => traversal::AnyHit::Accept,
            Decision::Ignore => traversal::AnyHit::Ignore,
            Decision::Terminate => traversal::AnyHit::Terminate,
        }
    }

    fn intersect(&mut self, context: &PrimitiveContext<'_>, reporter: &mut Reporter<'_, '_>) {
        let (call, ray) = (self.call, self.ray);
        let Some(entry) = &call.hit_programs(context.sbt_index).intersection else { return };
        let executor = AtPrimitive {
            call: &call,
            path: context.path,
            context,
            traversal: RefCell::new(self),
            reporter: RefCell::new(reporter),
        };
        let ray_and_hit = ray_and_hit(context, ray, 0, [0; 8]);
        let _ = call.run(entry, &call.launch.sbt.hit, context.sbt_index as usize, ray_and_hit, &executor);
    }

    #[cold]
    #[inline(never)]
    fn no_ray(&mut self, path: &InstancePath<'_>, object_ray: &traversal::Ray) {
        if self.call.launch.checked {
            checks::no_ray(path, object_ray);
        }
    }
}
