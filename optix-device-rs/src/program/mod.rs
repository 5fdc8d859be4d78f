//! Program contexts: what each kind of device program may ask, and nothing else (guide 13, table of legal calls).
//!
//! A context is zero-sized on the device and one pointer on the host. A program gets it by reference and can't keep it.
//!
//! | | [`RayGen`] | [`Intersection`] | [`AnyHit`] | [`ClosestHit`] | [`Miss`] | [`Exception`] | [`DirectCallable`] | [`ContinuationCallable`] |
//! | --- | --- | --- | --- | --- | --- | --- | --- | --- |
//! | launch index, launch parameters, handles, hit kinds | yes | yes | yes | yes | yes | yes | yes | yes |
//! | throws, calls direct callables | yes | yes | yes | yes | yes | | yes | yes |
//! | traces rays, calls continuation callables | yes | | | yes | yes | | | yes |
//! | its ray: world space, interval, time, flags, mask | | yes | yes | yes | yes | | | |
//! | its ray in object space | | yes | yes | | | | | |
//! | its primitive: index, instance, transform list, spaces | | yes | yes | yes | | | | |
//! | its hit: kind, face, attributes, barycentrics, vertices | | | yes | yes | | | | |
//! | reports hits | | yes | | | | | | |
//! | what was raised | | | | | | yes | | |
//!
//! A call from another kind of program does not compile. `docs/contracts.md` has the table by device function.

#[doc(hidden)]
pub mod entry;
mod handle;
mod kind;
mod transform;
mod unmarked;

pub use crate::intrinsics::{CallsContinuation, CallsDirect, Context};
pub use handle::{AccelHandle, InstanceHandle, TransformHandle, TransformType};
pub use kind::{Face, HitKind};
pub use transform::Transform;

use crate::callable::Signature;
use crate::data::DeviceData;
use crate::intrinsics::Invocation;
use crate::payload::Payload;
use crate::pipeline::Pipeline;
use crate::primitive::{Attributes, Reported};
use crate::ray::Decision;
use crate::record::SbtRecord;
use core::marker::PhantomData;

macro_rules! context {
    ($(#[$doc:meta])* $name:ident<P $(, $a:ident)?>) => {
        $(#[$doc])*
        pub struct $name<P $(, $a)?> {
            pub(crate) invocation: Invocation,
            types: PhantomData<(P, $($a)?)>,
        }

        impl<P $(, $a)?> $name<P $(, $a)?> {
            #[inline(always)]
            pub(crate) fn new(invocation: Invocation) -> Self {
                Self { invocation, types: PhantomData }
            }
        }

        #[cfg(not(target_arch = "nvptx64"))]
        impl<P $(, $a)?> $name<P $(, $a)?> {
            /// What the executor made for the call.
            #[inline(always)]
            #[allow(dead_code, reason = "some contexts ask by other ways")]
            pub(crate) fn frame(&self) -> &crate::host::Frame<'static> {
                self.invocation.frame()
            }
        }
    };
}

context! {
    /// Ray generation: one call per launch index (guide 2.2).
    RayGen<P>
}
context! {
    /// Intersection of a custom primitive; hits carry attributes `A` (guide 13.4).
    Intersection<P, A>
}
context! {
    /// Any-hit: decides about a candidate hit (guide 13.13).
    AnyHit<P, A>
}
context! {
    /// Closest-hit: shades the closest accepted hit.
    ClosestHit<P, A>
}
context! {
    /// Miss: the ray hit nothing.
    Miss<P>
}
context! {
    /// Direct callable: runs like a function call, and traces no rays (guide 15.1).
    DirectCallable<P>
}
context! {
    /// Continuation callable: runs through the scheduler, and may trace rays (guide 15.1).
    ContinuationCallable<P>
}
context! {
    /// Exception: is told why a launch index ended (guide 13.14). It calls, traces and throws nothing.
    Exception<P>
}

/// A ray-generation program; made by `#[raygen]`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't be a ray-generation program of pipeline `{P}`",
    label = "expected a function with `#[raygen]` whose context is `&RayGen<{P}>`"
)]
pub trait RayGenProgram<P: Pipeline> {
    /// What it reads from its record; `()` if nothing.
    type Record: SbtRecord;
    /// Calls the function.
    fn run(context: &RayGen<P>, record: &Self::Record);
}

/// A miss program for rays with payload `R`; made by `#[miss]`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't be the miss program of ray type `{R}` in pipeline `{P}`",
    label = "its context, payload or result is another's",
    note = "expected `#[miss] fn(ms: &Miss<{P}>, [record: &..], [ray: {R}AtMiss]) -> {R}FromMiss`; leave out what the payload does not have"
)]
pub trait MissProgram<P: Pipeline, R: Payload> {
    /// What it reads from its record; `()` if nothing.
    type Record: SbtRecord;
    /// Calls the function.
    fn run(context: &Miss<P>, record: &Self::Record, input: R::AtMiss) -> R::FromMiss;
}

/// A closest-hit program for hits `A` on material `Rec`, rays with payload `R`; made by `#[closesthit]`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't be the closest-hit program of material `{Rec}` for ray type `{R}` in pipeline `{P}`",
    label = "its context, record, payload or result is another's",
    note = "expected `#[closesthit] fn(hit: &ClosestHit<{P}, {A}>, [record: &{Rec}], [ray: {R}AtClosestHit]) -> {R}FromClosestHit`; leave out what the payload does not have"
)]
pub trait ClosestHitProgram<P: Pipeline, A: Attributes, Rec: SbtRecord, R: Payload> {
    /// Calls the function.
    fn run(context: &ClosestHit<P, A>, record: &Rec, input: R::AtClosestHit) -> R::FromClosestHit;
}

/// An any-hit program for hits `A` on material `Rec`, rays with payload `R`; made by `#[anyhit]`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't be the any-hit program of material `{Rec}` for ray type `{R}` in pipeline `{P}`",
    label = "its context, record, payload or result is another's",
    note = "expected `#[anyhit] fn(hit: &AnyHit<{P}, {A}>, [record: &{Rec}], [ray: {R}AtAnyHit]) -> Decision`, or `-> (Decision, {R}FromAnyHit)` where it writes the payload"
)]
pub trait AnyHitProgram<P: Pipeline, A: Attributes, Rec: SbtRecord, R: Payload> {
    /// Calls the function.
    fn run(context: &AnyHit<P, A>, record: &Rec, input: R::AtAnyHit) -> (Decision, R::FromAnyHit);
}

/// An intersection program of material `Rec`, rays with payload `R`; made by `#[intersection]`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't be the intersection program of material `{Rec}` for ray type `{R}` in pipeline `{P}`",
    label = "its context, record, payload or result is another's",
    note = "expected `#[intersection] fn(isect: &Intersection<{P}, ..>, [record: &{Rec}], [ray: {R}AtIntersection]) [-> {R}FromIntersection]`"
)]
pub trait IntersectionProgram<P: Pipeline, Rec: SbtRecord, R: Payload> {
    /// What its hits carry.
    type Attributes: Reported;
    /// Calls the function.
    fn run(context: &Intersection<P, Self::Attributes>, record: &Rec, input: R::AtIntersection) -> R::FromIntersection;
}

/// A direct callable; made by `#[direct_callable]`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't be a direct callable of pipeline `{P}`",
    label = "expected a function with `#[direct_callable]` whose context is `&DirectCallable<{P}>`"
)]
pub trait DirectCallableProgram<P: Pipeline> {
    /// What it reads from its record; `()` if nothing.
    type Record: SbtRecord;
    /// What it takes and returns, as a function type.
    type Signature: Signature;
    /// Calls the function.
    fn run(
        context: &DirectCallable<P>,
        record: &Self::Record,
        arguments: Arguments<Self::Signature>,
    ) -> Returned<Self::Signature>;
}

/// A continuation callable; made by `#[continuation_callable]`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't be a continuation callable of pipeline `{P}`",
    label = "expected a function with `#[continuation_callable]` whose context is `&ContinuationCallable<{P}>`"
)]
pub trait ContinuationCallableProgram<P: Pipeline> {
    /// What it reads from its record; `()` if nothing.
    type Record: SbtRecord;
    /// What it takes and returns, as a function type.
    type Signature: Signature;
    /// Calls the function.
    fn run(
        context: &ContinuationCallable<P>,
        record: &Self::Record,
        arguments: Arguments<Self::Signature>,
    ) -> Returned<Self::Signature>;
}

/// The arguments of a callable, as a tuple.
type Arguments<F> = <F as Signature>::Arguments;
/// What a callable returns.
type Returned<F> = <F as Signature>::Result;

/// An exception program; made by `#[exception]`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't be the exception program of pipeline `{P}`",
    label = "expected a function with `#[exception]` whose context is `&Exception<{P}>`"
)]
pub trait ExceptionProgram<P: Pipeline> {
    /// What it reads from its record; `()` if nothing.
    type Record: SbtRecord;
    /// Calls the function.
    fn run(context: &Exception<P>, record: &Self::Record);
}

/// Reads the record; its type was checked by `pipeline!` and its layout is [`DeviceData`]'s.
///
/// # Safety
/// The running program's record holds a `Rec`.
#[inline(always)]
unsafe fn record<Rec: DeviceData>(invocation: &Invocation) -> &Rec {
    if size_of::<Rec>() == 0 {
        // SAFETY: nothing is read; the address only has to be aligned.
        return unsafe { core::ptr::NonNull::dangling().as_ref() };
    }
    // SAFETY: the caller's; OptiX aligns record data to 16 bytes (guide 7.2), which `RecordLayout` checks to be enough.
    unsafe { &*invocation.record().cast::<Rec>() }
}
