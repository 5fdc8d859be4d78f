//! A program call on the host: what the program can see, and whom it asks.

use super::{Rule, end};
use crate::intrinsics::TraceCall;
use crate::ray::Ray;
use crate::words::WordBuffer;
use core::any::TypeId;
use core::cell::Cell;
use core::ptr::NonNull;
use glam::{UVec3, Vec3};
use std::ffi::CString;
use std::format;

/// What a hit, or a candidate, tells its program.
#[derive(Clone, Copy, Debug)]
pub struct HitState {
    /// Index in its build input, plus that input's offset.
    pub primitive_index: u32,
    /// Index of its record in its GAS.
    pub sbt_gas_index: u32,
    /// `!0` without an instance.
    pub instance_id: u32,
    /// 0 without an instance.
    pub instance_index: u32,
    /// 254 and 255: front and back of a triangle; 0 to 127: the program's own.
    pub kind: u8,
    /// Attribute words.
    pub attributes: [u32; 8],
}

impl HitState {
    /// For programs without a hit.
    pub const NONE: Self =
        Self { primitive_index: 0, sbt_gas_index: 0, instance_id: !0, instance_index: 0, kind: 0, attributes: [0; 8] };
}

/// What an exception program is told (guide 13.14).
#[derive(Clone, Debug)]
pub struct ExceptionState {
    /// Negative for OptiX's own: [`Raised`](crate::exception::Raised).
    pub code: i32,
    /// Details of a user exception.
    pub details: [u32; crate::exception::MAX_DETAILS],
    /// Where it was thrown, if that is known.
    pub line: Option<CString>,
}

impl ExceptionState {
    /// For other programs.
    pub const NONE: Self = Self { code: 0, details: [0; crate::exception::MAX_DETAILS], line: None };
    /// `OPTIX_EXCEPTION_CODE_STACK_OVERFLOW`.
    pub const STACK_OVERFLOW: Self = Self { code: crate::exception::STACK_OVERFLOW, ..Self::NONE };
}

/// A call of a callable (guide 15.2).
#[derive(Clone, Copy, Debug)]
pub struct CallableCall {
    /// The number that the reference holds.
    pub number: u32,
    /// Whether a continuation callable is called.
    pub continuation: bool,
    /// The signature's type, such as `fn(Vec2) -> Vec3`.
    pub signature: TypeId,
}

/// What the handle of an instance tells a program.
#[derive(Clone, Copy, Debug)]
pub struct InstanceState {
    /// The application's.
    pub id: u32,
    /// The handle of the structure placed.
    pub child: u64,
    /// To the space of its IAS: three rows.
    pub transform: [[f32; 4]; 3],
    /// From the space of its IAS: three rows.
    pub inverse: [[f32; 4]; 3],
}

/// Everything a program call on the host can see.
pub struct Frame<'a> {
    /// Who runs it.
    pub executor: &'a (dyn Executor + 'a),
    /// The launch index.
    pub launch_index: UVec3,
    /// The launch dimensions.
    pub launch_dimensions: UVec3,
    /// The launch parameters, a valid value of the pipeline's parameter type.
    pub params: NonNull<u8>,
    /// The data of the program's record, a valid value of its record type.
    pub record: NonNull<u8>,
    /// The payload, shared by all programs of a trace call. For a callable its arguments, then its result.
    pub payload: &'a Cell<WordBuffer>,
    /// Who is told of the fields that the program takes and gives; only an executor that checks wants to know.
    pub watch: Option<&'a dyn PayloadWatch>,
    /// The ray, in world space, as passed to trace; with the `tmax` that the program sees (guide 13.5).
    pub ray: Ray,
    /// Origin and direction in object space; intersection and any-hit programs only.
    pub object_ray: (Vec3, Vec3),
    /// The hit.
    pub hit: HitState,
    /// The exception; exception programs only.
    pub exception: &'a ExceptionState,
    /// Whether its program runs.
    pub turn: Turn,
}

/// Whether a program runs, or waits for one that it called: a trace call's, a callable, or those of a launch that it made.
///
/// Contexts are borrowed, but safe code can lend one further than to the functions that its program calls (a scoped thread-local
/// does). Only the program that runs may use its own: one that waits has, for instance, another pipeline's exceptions.
#[derive(Debug, Default)]
pub struct Turn {
    waits: Cell<bool>,
}

std::thread_local! {
    /// Whose turn it is on this thread.
    static RUNNING: Cell<Option<NonNull<Turn>>> = const { Cell::new(None) };
}

impl Turn {
    /// Whether another program runs.
    #[inline(always)]
    pub(crate) fn waits(&self) -> bool {
        self.waits.get()
    }

    /// Runs the program whose turn this is; that of the program around it is over meanwhile.
    #[inline(always)]
    pub(super) fn take<R>(&self, program: impl FnOnce() -> R) -> R {
        struct GiveBack(Option<NonNull<Turn>>);
        impl GiveBack {
            #[inline(always)]
            fn waits(&self, waits: bool) {
                if let Some(around) = self.0 {
                    // SAFETY: its owner is borrowed by `take` below on this thread's stack, which has not returned.
                    unsafe { around.as_ref() }.waits.set(waits);
                }
            }
        }
        impl Drop for GiveBack {
            #[inline(always)]
            fn drop(&mut self) {
                RUNNING.set(self.0);
                self.waits(false);
            }
        }
        let around = GiveBack(RUNNING.replace(Some(NonNull::from(self))));
        around.waits(true);
        program()
    }
}

/// Is told of a program's payload accesses before they happen. Fields are indices into
/// [`Payload::FIELDS`](crate::payload::Payload::FIELDS).
pub trait PayloadWatch {
    /// The program takes these fields.
    fn takes(&self, fields: &'static [usize]);
    /// The program gives these fields.
    fn gives(&self, fields: &'static [usize]);
}

/// What a program asks of the executor that runs it. What an executor does not have ends the launch index with the name of the
/// function: [`no_answer`].
#[expect(unused_variables, reason = "what has no answer reads no arguments")]
pub trait Executor {
    /// Traces a ray; `payload` goes in and comes back.
    fn trace(&self, call: &TraceCall, payload: &mut WordBuffer) {
        no_answer("trace")
    }
    /// Calls a callable; `words` are its arguments, then its result.
    fn call(&self, call: &CallableCall, words: &mut WordBuffer) {
        no_answer("call")
    }
    /// Reports a hit from an intersection program; true if it was accepted.
    fn report(&self, t: f32, kind: u8, count: usize, attributes: &WordBuffer) -> bool {
        no_answer("report")
    }
    /// The end of the ray's interval as an intersection program sees it (guide 13.5): changes while it reports.
    fn interval_end(&self) -> f32 {
        no_answer("ray_tmax")
    }
    /// The vertices of the triangle hit, in object space.
    fn triangle_vertices(&self) -> [Vec3; 3] {
        no_answer("vertices")
    }
    /// The GAS of the primitive.
    fn gas_traversable_handle(&self) -> u64 {
        no_answer("gas_handle")
    }
    /// Instances between the root of the trace and the primitive.
    fn transform_list_size(&self) -> u32 {
        no_answer("transform_list_size")
    }
    /// The handle of one of them, 0 nearest the root.
    fn transform_list_handle(&self, index: u32) -> u64 {
        no_answer("transform_list_handle")
    }
    /// The handle of an instance of an IAS.
    ///
    /// # Safety
    /// `ias` is the handle of an IAS of this launch, which has an instance `index`.
    unsafe fn instance_traversable_from_ias(&self, ias: u64, index: u32) -> u64 {
        no_answer("Instances::get")
    }
    /// What an instance's handle tells.
    ///
    /// # Safety
    /// `handle` came from this launch.
    unsafe fn instance(&self, handle: u64) -> InstanceState {
        no_answer("InstanceHandle")
    }
    /// The vertices of a triangle, in object space.
    ///
    /// # Safety
    /// `gas` is the handle of a GAS of this launch, which has such a triangle.
    unsafe fn triangle_vertices_from_handle(&self, gas: u64, primitive: u32, sbt_gas_index: u32) -> [Vec3; 3] {
        no_answer("TriangleVertices::get")
    }
    /// Three rows.
    fn object_to_world(&self) -> [[f32; 4]; 3] {
        no_answer("object_to_world")
    }
    /// Three rows.
    fn world_to_object(&self) -> [[f32; 4]; 3] {
        no_answer("world_to_object")
    }
}

/// Ends the launch index: the running program asks what its executor can't tell, by a function of this name.
#[cold]
pub fn no_answer(function: &str) -> ! {
    end::fail(Rule::Kind, format!("`{function}` has no answer in a program of this kind"))
}
