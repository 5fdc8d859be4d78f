//! A pipeline as a value: what `pipeline!` declares, for backends to read.

use super::Frame;
use crate::layout::Crossing;
use crate::params::Field;
use crate::primitive::PrimitiveType;
use crate::ray::Decision;
use core::any::TypeId;

/// A device program: its entry in the PTX and its host function.
#[derive(Clone, Copy)]
pub struct Entry {
    /// The name in the PTX, with its OptiX prefix (`__closesthit__..`).
    pub name: &'static str,
    /// The Rust function's path as written in `pipeline!`, for messages.
    pub function: &'static str,
    /// The program. [`run`](Self::run) runs it.
    #[doc(hidden)]
    pub body: unsafe fn(&Frame<'_>) -> Decision,
}

impl Entry {
    /// Runs the program on a frame. Programs other than any-hit return [`Decision::Accept`].
    ///
    /// # Safety
    /// What [`Invocation::new`](crate::intrinsics::Invocation::new) asks for.
    #[inline(always)]
    pub unsafe fn run(&self, frame: &Frame<'_>) -> Decision {
        // SAFETY: the caller's.
        frame.turn.take(|| unsafe { (self.body)(frame) })
    }
}

impl core::fmt::Debug for Entry {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.name)
    }
}

/// Size and alignment of a record's data, and which type it is.
#[derive(Clone, Copy, Debug)]
pub struct RecordLayout {
    /// The type's name.
    pub name: &'static str,
    /// Bytes, without the header.
    pub size: usize,
    /// Bytes; at most 16 (guide 7.2).
    pub align: usize,
}

impl RecordLayout {
    /// Of a record type.
    pub const fn of<R: crate::record::SbtRecord>() -> Self {
        assert!(align_of::<R>() <= 16, "an SBT record's data is aligned to 16 bytes at most (guide 7.2)");
        Self { name: R::NAME, size: size_of::<R>(), align: align_of::<R>() }
    }
}

/// A payload's fields, its registers and their semantics.
#[derive(Clone, Copy, Debug)]
pub struct PayloadDescription {
    /// The type's name.
    pub name: &'static str,
    /// `OptixPayloadSemantics` bits per register; its length is the register count.
    pub semantics: &'static [u32],
    /// The fields and their words: registers, or words in memory.
    pub fields: &'static [crate::payload::Field],
    /// The words in memory of the caller, whose address the registers hold; 0 where the registers hold the words.
    pub memory_words: usize,
}

impl PayloadDescription {
    /// Of a payload type.
    pub const fn of<R: crate::payload::Payload>() -> Self {
        let pointer = <R::Transport as crate::payload::Transport>::POINTER;
        assert!(pointer || R::WORDS == R::SEMANTICS.len());
        Self {
            name: R::NAME,
            semantics: R::SEMANTICS,
            fields: R::FIELDS,
            memory_words: if pointer { R::WORDS } else { 0 },
        }
    }
}

/// A program with a record of its own: ray generation or miss.
#[derive(Clone, Copy, Debug)]
pub struct ProgramDescription {
    /// The program.
    pub entry: Entry,
    /// Its record.
    pub record: RecordLayout,
}

/// A callable, of which a scene makes any number of records.
#[derive(Clone, Copy, Debug)]
pub struct CallableDescription {
    /// The program.
    pub entry: Entry,
    /// Its record.
    pub record: RecordLayout,
    /// Whether it is a continuation callable.
    pub continuation: bool,
    /// The signature's type, such as `fn(Vec2) -> Vec3`.
    pub signature: TypeId,
}

impl CallableDescription {
    /// Of a program with record `R`, signature `F` and kind `K`.
    pub const fn of<R, F, K>(entry: Entry) -> Self
    where
        R: crate::record::SbtRecord,
        F: crate::callable::Signature,
        K: crate::callable::CallableKind,
    {
        let (record, signature) = (RecordLayout::of::<R>(), TypeId::of::<F>());
        Self { entry, record, continuation: K::IS_CONTINUATION, signature }
    }
}

/// The exceptions of a pipeline (guide 13.14).
#[derive(Clone, Copy, Debug)]
pub struct ExceptionsDescription {
    /// What programs may throw: the type's name; none if they throw nothing.
    pub throws: Option<&'static str>,
    /// Code and name of each of these exceptions.
    pub variants: &'static [(u32, &'static str)],
    /// The exception program.
    pub program: Option<ProgramDescription>,
}

impl ExceptionsDescription {
    /// Whether the pipeline wants to know of any exception.
    pub const fn are_declared(&self) -> bool {
        self.throws.is_some() || self.program.is_some()
    }
}

/// A ray type.
#[derive(Clone, Copy, Debug)]
pub struct RayDescription {
    /// The payload.
    pub payload: PayloadDescription,
    /// The miss program; none where the payload needs none.
    pub miss: Option<ProgramDescription>,
}

/// The programs of a hit group for one ray type.
#[derive(Clone, Copy, Debug)]
pub struct HitPrograms {
    /// Closest hit.
    pub closesthit: Option<Entry>,
    /// Any hit.
    pub anyhit: Option<Entry>,
    /// Intersection; there for custom primitives.
    pub intersection: Option<Entry>,
}

/// A material on a geometry kind: one hit group per ray type.
#[derive(Clone, Copy, Debug)]
pub struct HitGroupDescription {
    /// The material's record.
    pub record: RecordLayout,
    /// The kind of geometry.
    pub geometry: PrimitiveType,
    /// Attribute words of its hits.
    pub attribute_words: usize,
    /// Per ray type, in the order of [`PipelineDescription::rays`].
    pub rays: &'static [HitPrograms],
}

/// The launch parameters.
#[derive(Clone, Copy, Debug)]
pub struct ParamsDescription {
    /// The type's name.
    pub name: &'static str,
    /// The constant-memory variable in the PTX.
    pub symbol: &'static str,
    /// Bytes.
    pub size: usize,
    /// Bytes.
    pub align: usize,
    /// The fields.
    pub fields: &'static [Field],
}

impl ParamsDescription {
    /// Of a parameter type.
    pub const fn of<P: crate::params::LaunchParams>() -> Self {
        Self { name: P::NAME, symbol: P::SYMBOL, size: size_of::<P>(), align: align_of::<P>(), fields: P::FIELDS }
    }
}

/// All of a pipeline.
#[derive(Clone, Copy, Debug)]
pub struct PipelineDescription {
    /// The type's name.
    pub name: &'static str,
    /// The launch parameters.
    pub params: ParamsDescription,
    /// The ray-generation programs.
    pub raygen: &'static [ProgramDescription],
    /// The ray types; the index is SBT offset, miss index and payload type.
    pub rays: &'static [RayDescription],
    /// The hit groups.
    pub hitgroups: &'static [HitGroupDescription],
    /// The callables.
    pub callables: &'static [CallableDescription],
    /// The exceptions.
    pub exceptions: ExceptionsDescription,
    /// The types that cross between host and device.
    pub crossings: &'static [Crossing],
    /// The variable in the PTX that has the device's numbers of them: [`Crossing::table`].
    pub layouts: &'static str,
    /// The greatest depth of nested trace calls, where `pipeline!` states one (`trace_depth: 4`); otherwise it follows
    /// from which programs trace which rays.
    pub trace_depth: Option<u32>,
    /// The most callables that run one inside of the other, where `pipeline!` states it (`callable_depth: 2`); otherwise it
    /// follows from which programs call callables of which signatures.
    pub callable_depth: Option<u32>,
}
