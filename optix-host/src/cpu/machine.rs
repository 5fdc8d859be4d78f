//! The program call: frames for programs, programs through the shader binding table.

use super::kernel::{self, Accel, Candidate, InstancePath, Programs, RayQuery, Reporter, Site};
use crate::pipeline::Plan;
use crate::sbt::{Section, ShaderBindingTable};
use crate::{Error, Result};
use core::cell::{Cell, RefCell};
use core::ptr::NonNull;
use glam::{UVec3, Vec3};
use optix_device_rs::host::{Entry, Executor, Frame, HitPrograms, HitState, TraceCall};
use optix_device_rs::prelude::{Decision, Ray};
use optix_device_rs::words::WordBuffer;
use rayon::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Launch indices that a thread takes at a time.
const CHUNK: u64 = 64;

/// A launch.
pub(super) struct Job<'a> {
    plan: &'a Plan,
    sbt: &'a ShaderBindingTable,
    /// A copy of the parameters at an address that is a multiple of 16.
    params: Vec<u128>,
    raygen: usize,
    dimensions: UVec3,
}

impl<'a> Job<'a> {
    pub fn new(
        plan: &'a Plan,
        sbt: &'a ShaderBindingTable,
        params: &[u8],
        raygen: usize,
        dimensions: [u32; 3],
    ) -> Self {
        let mut copy = vec![0u128; params.len().div_ceil(16).max(1)];
        bytemuck::cast_slice_mut(&mut copy)[..params.len()].copy_from_slice(params);
        Self { plan, sbt, params: copy, raygen, dimensions: dimensions.into() }
    }

    fn hit_programs(&self, sbt_index: u32) -> Option<&HitPrograms> {
        let slot = self.sbt.hit.programs().get(sbt_index as usize)?;
        Some(&self.plan.description.hitgroups[slot.group].rays[slot.ray])
    }
}

/// Runs the launch on all threads of the current pool.
pub(super) fn run(job: &Job<'_>) -> Result<()> {
    let size = job.dimensions.as_u64vec3();
    let total = size.x * size.y * size.z;
    let failed = AtomicBool::new(false);
    let first: Mutex<Option<(u64, Error)>> = Mutex::new(None);
    (0..total.div_ceil(CHUNK)).into_par_iter().for_each(|chunk| {
        for linear in chunk * CHUNK..((chunk + 1) * CHUNK).min(total) {
            if failed.load(Relaxed) {
                return;
            }
            let index = UVec3::new(
                (linear % size.x) as u32,
                (linear / size.x % size.y) as u32,
                (linear / (size.x * size.y)) as u32,
            );
            if let Err(error) = run_index(job, index) {
                failed.store(true, Relaxed);
                let mut first = first.lock().unwrap_or_else(|e| e.into_inner());
                if first.as_ref().is_none_or(|(at, _)| linear < *at) {
                    *first = Some((linear, error));
                }
            }
        }
    });
    match first.into_inner().unwrap_or_else(|e| e.into_inner()) {
        Some((_, error)) => Err(error),
        None => Ok(()),
    }
}

/// What ends a launch index: carried by unwinding out of the programs.
struct Trap(String);

fn run_index(job: &Job<'_>, index: UVec3) -> Result<()> {
    let raygen = &job.plan.description.raygen[job.raygen].entry;
    let call = Call { job, index, depth: 0, running: &Cell::new(raygen.name), payload: &Cell::new(WordBuffer::ZERO) };
    let outcome = catch_unwind(AssertUnwindSafe(|| {
        let _ = call.run(
            raygen,
            &job.sbt.raygen,
            job.raygen,
            Ray::new(Vec3::ZERO, Vec3::ZERO),
            HitState::NONE,
            None,
            &call,
        );
    }));
    outcome.map_err(|panic| {
        let what = if let Some(Trap(what)) = panic.downcast_ref() {
            what.clone()
        } else if let Some(what) = panic.downcast_ref::<String>() {
            what.clone()
        } else {
            panic.downcast_ref::<&str>().map_or("it panicked".into(), |what| what.to_string())
        };
        Error::Program { program: call.running.get().into(), index: index.to_array(), what }
    })
}

/// What all program calls of one trace share.
#[derive(Clone, Copy)]
struct Call<'c> {
    job: &'c Job<'c>,
    index: UVec3,
    /// Trace calls around this one.
    depth: u32,
    /// The program that runs, for messages.
    running: &'c Cell<&'static str>,
    payload: &'c Cell<WordBuffer>,
}

impl Call<'_> {
    fn trap(&self, what: String) -> ! {
        resume_unwind(Box::new(Trap(what)))
    }

    /// Runs a program with the data of record `index` of `section`.
    #[allow(clippy::too_many_arguments)]
    fn run<K>(
        &self,
        entry: &Entry,
        section: &Section<K>,
        index: usize,
        ray: Ray,
        hit: HitState,
        object_ray: Option<(Vec3, Vec3)>,
        executor: &dyn Executor,
    ) -> Decision {
        let frame = Frame {
            executor,
            launch_index: self.index,
            launch_dimensions: self.job.dimensions,
            params: NonNull::from(&self.job.params[..]).cast(),
            record: NonNull::from(section.data(index)).cast(),
            payload: self.payload,
            ray,
            object_ray: object_ray.unwrap_or_default(),
            hit,
        };
        let caller = self.running.replace(entry.name);
        // SAFETY: the parameters were lowered from `P::Params` of the pipeline that the entry belongs to, and the section's
        // record from the record type that `pipeline!` tied to the program; both are aligned to 16 and outlive the call.
        let decision = unsafe { (entry.run)(&frame) };
        self.running.set(caller);
        decision
    }

    fn trace(&self, trace: &TraceCall, payload: &mut WordBuffer) {
        let depth = self.depth + 1;
        if depth > self.job.plan.trace_depth {
            self.trap(format!(
                "trace calls nest deeper than the pipeline's trace depth of {} (guide 12)",
                self.job.plan.trace_depth
            ));
        }
        let words = Cell::new(*payload);
        let mut call = Call { depth, payload: &words, ..*self };
        let ray = trace.ray;
        let query = RayQuery {
            origin: ray.origin.to_array(),
            direction: ray.direction.to_array(),
            tmin: ray.tmin,
            tmax: ray.tmax,
            time: ray.time,
            mask: ray.mask,
            flags: ray.flags.bits(),
            sbt_offset: trace.sbt_offset,
            sbt_stride: trace.sbt_stride,
        };
        let root = core::ptr::with_exposed_provenance::<Accel>(trace.traversable as usize);
        // SAFETY: a traversable is null or comes from a `World` that the launch keeps alive, of this device (checked).
        let root = unsafe { root.as_ref() };
        let mut traversal = Traversal { call, ray };
        match kernel::trace(root, &query, &mut traversal) {
            None => {
                let miss = trace.miss_index as usize;
                if let Some(program) = self.job.plan.description.rays[miss].miss {
                    let _ = call.run(&program.entry, &self.job.sbt.miss, miss, ray, HitState::NONE, None, &call);
                }
            }
            Some(hit) if !ray.flags.closesthit_disabled() => {
                call = traversal.call;
                let Some(programs) = self.job.hit_programs(hit.sbt_index) else { self.no_record(hit.sbt_index) };
                if let Some(entry) = &programs.closesthit {
                    let state = HitState {
                        primitive_index: hit.primitive_index,
                        sbt_gas_index: hit.sbt_gas_index,
                        instance_id: hit.path.instance_id(),
                        instance_index: hit.path.instance_index(),
                        kind: hit.hit_kind,
                        attributes: hit.attributes,
                    };
                    let vertices = || hit.triangle_vertices();
                    let executor = AtHit { call, path: &hit.path, vertices: &vertices };
                    let seen = Ray { tmax: hit.t, ..ray };
                    let _ = call.run(entry, &self.job.sbt.hit, hit.sbt_index as usize, seen, state, None, &executor);
                }
            }
            Some(_) => {}
        }
        *payload = words.get();
    }

    fn no_record(&self, sbt_index: u32) -> ! {
        self.trap(format!(
            "a hit asks for record {sbt_index} of the hit-group table, which has {} (guide 7.3)",
            self.job.sbt.hit.programs().len()
        ))
    }
}

/// Programs that have no hit.
impl Executor for Call<'_> {
    fn trace(&self, call: &TraceCall, payload: &mut WordBuffer) {
        Call::trace(self, call, payload);
    }
    fn report(&self, _: f32, _: u8, _: usize, _: &WordBuffer) -> bool {
        self.trap("only an intersection program reports hits".into())
    }
    fn interval_end(&self) -> f32 {
        self.trap("only an intersection program has an interval that shrinks".into())
    }
    fn triangle_vertices(&self) -> [Vec3; 3] {
        self.trap("there is no triangle".into())
    }
    fn object_to_world(&self) -> [[f32; 4]; 3] {
        self.trap("there is no hit, so no transform".into())
    }
    fn world_to_object(&self) -> [[f32; 4]; 3] {
        self.trap("there is no hit, so no transform".into())
    }
}

/// Programs at a primitive: closest-hit and any-hit.
struct AtHit<'c> {
    call: Call<'c>,
    path: &'c InstancePath<'c>,
    vertices: &'c dyn Fn() -> Option<[[f32; 3]; 3]>,
}

fn rows(matrix: [f32; 12]) -> [[f32; 4]; 3] {
    bytemuck::cast(matrix)
}

impl Executor for AtHit<'_> {
    fn trace(&self, call: &TraceCall, payload: &mut WordBuffer) {
        self.call.trace(call, payload);
    }
    fn report(&self, t: f32, kind: u8, count: usize, attributes: &WordBuffer) -> bool {
        self.call.report(t, kind, count, attributes)
    }
    fn interval_end(&self) -> f32 {
        self.call.interval_end()
    }
    fn triangle_vertices(&self) -> [Vec3; 3] {
        match (self.vertices)() {
            Some(vertices) => vertices.map(Vec3::from_array),
            None => self.call.triangle_vertices(),
        }
    }
    fn object_to_world(&self) -> [[f32; 4]; 3] {
        rows(self.path.object_to_world())
    }
    fn world_to_object(&self) -> [[f32; 4]; 3] {
        rows(self.path.world_to_object())
    }
}

/// An intersection program at its primitive.
struct AtPrimitive<'c, 'p, 't, 'r, 's> {
    at: AtHit<'c>,
    traversal: RefCell<&'t mut Traversal<'p>>,
    reporter: RefCell<&'t mut Reporter<'r, 's>>,
}

impl Executor for AtPrimitive<'_, '_, '_, '_, '_> {
    fn trace(&self, call: &TraceCall, payload: &mut WordBuffer) {
        self.at.trace(call, payload);
    }
    fn report(&self, t: f32, kind: u8, count: usize, attributes: &WordBuffer) -> bool {
        // The any-hit program that this may call gets executors of its own, so neither cell is borrowed twice.
        self.reporter.borrow_mut().report(&mut **self.traversal.borrow_mut(), t, kind, &attributes.0[..count])
    }
    fn interval_end(&self) -> f32 {
        self.reporter.borrow().tmax()
    }
    fn triangle_vertices(&self) -> [Vec3; 3] {
        self.at.triangle_vertices()
    }
    fn object_to_world(&self) -> [[f32; 4]; 3] {
        self.at.object_to_world()
    }
    fn world_to_object(&self) -> [[f32; 4]; 3] {
        self.at.world_to_object()
    }
}

/// The programs that run while a ray is traversed.
struct Traversal<'c> {
    call: Call<'c>,
    ray: Ray,
}

impl Traversal<'_> {
    fn state(site: &Site<'_>, kind: u8, attributes: [u32; 8]) -> HitState {
        HitState {
            primitive_index: site.primitive_index,
            sbt_gas_index: site.sbt_gas_index,
            instance_id: site.path.instance_id(),
            instance_index: site.path.instance_index(),
            kind,
            attributes,
        }
    }
}

fn object_ray(site: &Site<'_>) -> Option<(Vec3, Vec3)> {
    Some((Vec3::from_array(site.object_ray.origin), Vec3::from_array(site.object_ray.direction)))
}

impl Programs for Traversal<'_> {
    fn any_hit(&mut self, candidate: &Candidate<'_>) -> kernel::AnyHit {
        let (call, site) = (&self.call, &candidate.site);
        let Some(programs) = call.job.hit_programs(site.sbt_index) else { call.no_record(site.sbt_index) };
        let Some(entry) = &programs.anyhit else { return kernel::AnyHit::Accept };
        let state = Self::state(site, candidate.hit_kind, candidate.attributes);
        let vertices = || site.gas.triangle_vertices(site.sbt_gas_index, site.primitive_index);
        let executor = AtHit { call: *call, path: site.path, vertices: &vertices };
        let seen = Ray { tmax: candidate.t, ..self.ray };
        let record = site.sbt_index as usize;
        match call.run(entry, &call.job.sbt.hit, record, seen, state, object_ray(site), &executor) {
            Decision::Accept => kernel::AnyHit::Accept,
            Decision::Ignore => kernel::AnyHit::Ignore,
            Decision::Terminate => kernel::AnyHit::Terminate,
        }
    }

    fn intersect(&mut self, site: &Site<'_>, reporter: &mut Reporter<'_, '_>) {
        let (call, ray) = (self.call, self.ray);
        let Some(programs) = call.job.hit_programs(site.sbt_index) else { call.no_record(site.sbt_index) };
        let Some(entry) = &programs.intersection else { return };
        let state = Self::state(site, 0, [0; 8]);
        let executor = AtPrimitive {
            at: AtHit { call, path: site.path, vertices: &|| None },
            traversal: RefCell::new(self),
            reporter: RefCell::new(reporter),
        };
        let _ = call.run(entry, &call.job.sbt.hit, site.sbt_index as usize, ray, state, object_ray(site), &executor);
    }
}
