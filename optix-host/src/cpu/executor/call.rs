//! Program calls and trace calls.

use super::Launch;
use super::checks::{self, Watch};
use super::handle::{self, rows};
use super::stack::{Left, Stack};
use super::traversal::{AtHit, Traversal};
use crate::cpu::traversal::{self, Accel, RayQuery};
use crate::sbt::Section;
use core::cell::Cell;
use core::ptr::NonNull;
use glam::{UVec3, Vec3};
use optix_device_rs::exception::TRACE_DEPTH_EXCEEDED;
use optix_device_rs::host::end::{fail, goes_on, throw};
use optix_device_rs::host::{
    CallableCall, Entry, ExceptionState, Executor, Frame, HitPrograms, HitState, InstanceState, PayloadWatch, Rule,
    TraceCall, Turn,
};
use optix_device_rs::prelude::{Decision, Ray};
use optix_device_rs::words::WordBuffer;

/// Ends the launch index, because a program uses something that it kept from another launch.
#[cold]
fn not_held(what: &str) -> ! {
    fail(
        Rule::Held,
        format!(
            "a {what} is used that this launch's parameters and records do not hold: it was kept from another launch"
        ),
    )
}

/// What all program calls of one trace call share.
#[derive(Clone, Copy)]
pub(super) struct Call<'c> {
    pub launch: &'c Launch<'c>,
    index: UVec3,
    /// The number of trace calls that this one is nested in.
    depth: u32,
    /// The number of callables that this one is nested in, within the innermost trace call.
    callables: u32,
    stack: Stack,
    /// The entry name of the program that runs, for messages.
    running: &'c Cell<&'static str>,
    payload: &'c Cell<WordBuffer>,
    /// In the checked mode, what is known of the payload.
    watch: Option<&'c Watch>,
}

/// What a program sees of its ray and hit.
pub(super) struct RayAndHit {
    /// With the `tmax` that the program sees.
    pub ray: Ray,
    /// Origin and direction in object space, for programs that may ask.
    pub object_ray: (Vec3, Vec3),
    pub hit: HitState,
}

impl RayAndHit {
    const NO_OBJECT: (Vec3, Vec3) = (Vec3::ZERO, Vec3::ZERO);
    /// For programs that have no ray.
    const NOTHING: Self = {
        let flags = optix_device_rs::prelude::RayFlags::NONE;
        let ray = Ray { origin: Vec3::ZERO, direction: Vec3::ZERO, tmin: 0.0, tmax: 0.0, time: 0.0, mask: 0, flags };
        Self { ray, object_ray: Self::NO_OBJECT, hit: HitState::NONE }
    };

    fn without_hit(ray: Ray) -> Self {
        Self { ray, object_ray: Self::NO_OBJECT, hit: HitState::NONE }
    }
}

impl<'c> Call<'c> {
    /// A call that is not nested in another program's.
    fn root(
        launch: &'c Launch<'c>,
        index: UVec3,
        running: &'c Cell<&'static str>,
        payload: &'c Cell<WordBuffer>,
    ) -> Self {
        let stack = Stack::of_this_thread();
        Self { launch, index, depth: 0, callables: 0, stack, running, payload, watch: None }
    }

    /// Ends the launch index if the stack does not have room for another program.
    fn check_stack(&self) {
        #[cold]
        fn overflow(launch: &Launch<'_>) -> ! {
            if launch.exceptions.stack_overflow {
                // SAFETY: it has no details.
                unsafe { throw(ExceptionState::STACK_OVERFLOW) };
            }
            fail(Rule::Stack, "programs call each other so deep that the stack of the CPU's thread is used up".into())
        }
        #[cold]
        fn elsewhere() -> ! {
            fail(Rule::OtherStack, Rule::OtherStack.what().into())
        }
        match self.stack.left() {
            Left::Enough => {}
            Left::Nothing => overflow(self.launch),
            Left::Elsewhere => elsewhere(),
        }
    }

    /// Runs the launch's ray-generation program for a launch index.
    pub fn raygen(launch: &'c Launch<'c>, index: UVec3, running: &'c Cell<&'static str>) {
        // A ray-generation program has no payload, but the frame needs one.
        let payload = Cell::new(WordBuffer::ZERO);
        let call = Call::root(launch, index, running, &payload);
        // A program may have made this launch, so the stack may be used already.
        call.check_stack();
        let entry = &launch.description.raygen[launch.raygen].entry;
        let _ = call.run(entry, &launch.sbt.raygen, launch.raygen, RayAndHit::NOTHING, &call);
    }

    /// Runs the exception program, if there is one. Returns whether there is.
    pub fn exception(
        launch: &'c Launch<'c>,
        index: UVec3,
        running: &'c Cell<&'static str>,
        exception: &ExceptionState,
    ) -> bool {
        let Some(program) = &launch.description.exceptions.program else { return false };
        let payload = Cell::new(WordBuffer::ZERO);
        let call = Call::root(launch, index, running, &payload);
        let _ = call.run_with(&program.entry, &launch.sbt.exception, 0, RayAndHit::NOTHING, exception, &call);
        true
    }

    /// Runs a program with the data of record `record` of `section`.
    #[inline]
    pub fn run<K>(
        &self,
        entry: &Entry,
        section: &Section<K>,
        record: usize,
        ray_and_hit: RayAndHit,
        executor: &dyn Executor,
    ) -> Decision {
        self.run_with(entry, section, record, ray_and_hit, &ExceptionState::NONE, executor)
    }

    #[inline]
    fn run_with<K>(
        &self,
        entry: &Entry,
        section: &Section<K>,
        record: usize,
        ray_and_hit: RayAndHit,
        exception: &ExceptionState,
        executor: &dyn Executor,
    ) -> Decision {
        let frame = Frame {
            executor,
            launch_index: self.index,
            launch_dimensions: self.launch.dimensions,
            params: NonNull::from(&self.launch.params[..]).cast(),
            record: NonNull::from(section.data(record)).cast(),
            payload: self.payload,
            watch: self.watch.map(|watch| watch as &dyn PayloadWatch),
            ray: ray_and_hit.ray,
            object_ray: ray_and_hit.object_ray,
            hit: ray_and_hit.hit,
            exception,
            turn: Turn::default(),
        };
        let caller = self.running.replace(entry.name);
        // SAFETY: the parameters were lowered from `P::Params` of the pipeline that the entry belongs to, and the section's
        // record from the record type that `pipeline!` tied to the program; both are aligned to 16 and outlive the call.
        let decision = unsafe { entry.run(&frame) };
        // If the program caught the unwinding that ended its launch index, the index ends again here.
        goes_on();
        self.running.set(caller);
        decision
    }

    /// Traces a ray; the programs find the payload in `payload` and leave it there.
    pub fn trace(&self, trace: &TraceCall, payload: &mut WordBuffer) {
        let launch = self.launch;
        let depth = self.depth + 1;
        if depth > launch.depths.trace {
            if launch.exceptions.trace_depth {
                // SAFETY: it has no details.
                unsafe { throw(ExceptionState { code: TRACE_DEPTH_EXCEEDED, ..ExceptionState::NONE }) };
            }
            fail(
                Rule::TraceDepth,
                format!("trace calls nest deeper than the pipeline's trace depth of {}", launch.depths.trace),
            );
        }
        self.check_stack();
        let watch = launch.checked.then(|| checks::trace(launch, trace));
        let payload = Cell::from_mut(payload);
        let call = Call { depth, callables: 0, payload, watch: watch.as_ref(), ..*self };
        call.find(trace);
        if let Some(watch) = &watch {
            watch.returns(trace.caller_reads);
        }
    }

    /// Calls a callable. It finds its arguments in `words` and leaves its result there.
    pub fn call(&self, call: &CallableCall, words: &mut WordBuffer) {
        let launch = self.launch;
        let Some(index) = launch.reached.callables.get(call.number) else {
            fail(
                Rule::CallableRecord,
                "a callable is called that the scene of this launch did not have when the pipeline was built: it was kept from another \
                 launch"
                    .into(),
            )
        };
        let callable = &launch.description.callables[launch.sbt.callables.programs()[index].program];
        if (callable.continuation, callable.signature) != (call.continuation, call.signature) {
            fail(
                Rule::CallableSignature,
                format!("{} is called with another signature or as another kind", callable.entry.name),
            );
        }
        let callables = self.callables + 1;
        if callables > launch.depths.callables() {
            fail(
                Rule::CallableDepth,
                format!("callables call each other deeper than the pipeline's {} levels", launch.depths.callables()),
            );
        }
        self.check_stack();
        let callee = Call { callables, payload: Cell::from_mut(words), watch: None, ..*self };
        let _ = callee.run(&callable.entry, &launch.sbt.callables, index, RayAndHit::NOTHING, &callee);
    }

    /// The programs of a hit record. One of them is about to run.
    #[inline]
    pub fn hit_programs(&self, sbt_index: u32) -> &'c HitPrograms {
        let (ray, programs) = self.launch.hit_programs(sbt_index);
        if let Some(watch) = self.watch {
            watch.runs(ray);
        }
        programs
    }

    /// Traverses, and runs the closest-hit or the miss program.
    fn find(&self, trace: &TraceCall) {
        // Without motion, rays have no time (guide 13.5).
        let (launch, ray) = (self.launch, Ray { time: 0.0, ..trace.ray });
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
        let root = match trace.traversable {
            0 => None,
            handle => Some(launch.reached.traced.get(handle).unwrap_or_else(|| not_held("traversable"))),
        };
        let Some(hit) = traversal::trace(root, &query, &mut Traversal { call: *self, ray }) else {
            if let Some(program) = &launch.ray(trace.miss_index).miss {
                if let Some(watch) = self.watch {
                    watch.runs(trace.miss_index as usize);
                }
                let miss = trace.miss_index as usize;
                let _ = self.run(&program.entry, &launch.sbt.miss, miss, RayAndHit::without_hit(ray), self);
            }
            return;
        };
        if ray.flags.closesthit_disabled() {
            return;
        }
        if let Some(entry) = &self.hit_programs(hit.sbt_index).closesthit {
            let state = HitState {
                primitive_index: hit.primitive_index,
                sbt_gas_index: hit.sbt_gas_index,
                instance_id: hit.path.instance_id(),
                instance_index: hit.path.instance_index(),
                kind: hit.hit_kind,
                attributes: hit.attributes,
            };
            let executor = AtHit { call: self, path: &hit.path, vertices: || hit.triangle_vertices() };
            let ray_and_hit =
                RayAndHit { ray: Ray { tmax: hit.t, ..ray }, object_ray: RayAndHit::NO_OBJECT, hit: state };
            let _ = self.run(entry, &launch.sbt.hit, hit.sbt_index as usize, ray_and_hit, &executor);
        }
    }
}

/// What programs without a hit may ask: the trait's defaults end those that ask about one.
impl Executor for Call<'_> {
    fn trace(&self, call: &TraceCall, payload: &mut WordBuffer) {
        Call::trace(self, call, payload);
    }
    fn call(&self, call: &CallableCall, words: &mut WordBuffer) {
        Call::call(self, call, words);
    }
    unsafe fn instance_traversable_from_ias(&self, ias: u64, index: u32) -> u64 {
        let built = match self.launch.reached.read.get(ias) {
            Some(Accel::Ias(ias)) => ias.instances().get(index as usize),
            _ => None,
        };
        built.map_or_else(|| not_held("table of instances"), handle::of)
    }
    unsafe fn instance(&self, handle: u64) -> InstanceState {
        // SAFETY: the caller's.
        let Some(built) = (unsafe { handle::instance(handle) }) else {
            fail(Rule::InstanceHandle, "a handle is of no instance".into())
        };
        InstanceState {
            id: built.instance.id,
            child: handle::of(&*built.instance.child),
            transform: rows(built.instance.transform),
            inverse: rows(built.inverse_transform()),
        }
    }
    unsafe fn triangle_vertices_from_handle(&self, gas: u64, primitive: u32, sbt_gas_index: u32) -> [Vec3; 3] {
        let vertices = match self.launch.reached.read.get(gas) {
            Some(Accel::Gas(gas)) => gas.triangle_vertices(sbt_gas_index, primitive),
            _ => not_held("table of triangles"),
        };
        match vertices {
            Some(vertices) => vertices.map(Vec3::from_array),
            None => fail(Rule::TriangleIndex, format!("there is no triangle {primitive} of record {sbt_gas_index}")),
        }
    }
}
