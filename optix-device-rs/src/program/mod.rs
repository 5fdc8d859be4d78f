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

mod call;
pub(crate) use call::Here;
pub use call::{CallsContinuation, CallsDirect, Context};
#[doc(hidden)]
pub mod entry;
mod exception;
mod handle;
mod hit;
mod kind;
mod trace;
mod transform;
mod unmarked;

pub use handle::{AccelHandle, InstanceHandle, TransformHandle, TransformType};
pub use kind::{Face, HitKind};
pub use transform::Transform;

use crate::callable::Signature;
use crate::data::DeviceData;
use crate::machine::Cx;
use crate::params::LaunchParams;
use crate::payload::Payload;
use crate::pipeline::Pipeline;
use crate::primitive::{Attributes, Reported};
use crate::ray::{Decision, RayFlags};
use crate::record::SbtRecord;
use crate::words::{WordBuffer, part_mut};
use core::marker::PhantomData;
use glam::{UVec3, Vec3};

macro_rules! context {
    ($(#[$doc:meta])* $name:ident<P $(, $a:ident)?>) => {
        $(#[$doc])*
        pub struct $name<P $(, $a)?> {
            pub(crate) cx: Cx,
            types: PhantomData<(P, $($a)?)>,
        }

        impl<P $(, $a)?> $name<P $(, $a)?> {
            #[inline(always)]
            pub(crate) fn new(cx: Cx) -> Self {
                Self { cx, types: PhantomData }
            }
        }

        impl<P: Pipeline $(, $a)?> $name<P $(, $a)?> {
            /// The launch parameters, field by field (guide 6.5).
            #[inline(always)]
            pub fn params(&self) -> <P::Params as LaunchParams>::View<'_> {
                self.cx.params::<P::Params>().into()
            }
        }

        impl<P $(, $a)?> $name<P $(, $a)?> {
            /// This launch index (guide 13.1).
            #[inline(always)]
            pub fn launch_index(&self) -> UVec3 {
                self.cx.launch_index()
            }

            /// The launch's dimensions (guide 13.1).
            #[inline(always)]
            pub fn launch_dimensions(&self) -> UVec3 {
                self.cx.launch_dimensions()
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

/// Ray queries: intersection, any-hit, closest-hit and miss programs (guide 13.5).
macro_rules! ray_queries {
    ($($name:ident<P $(, $a:ident)?>),*) => {$(
        impl<P $(, $a)?> $name<P $(, $a)?> {
            /// Origin in world space, as passed to trace.
            #[inline(always)]
            pub fn world_ray_origin(&self) -> Vec3 {
                self.cx.world_ray_origin()
            }
            /// Direction in world space, as passed to trace.
            #[inline(always)]
            pub fn world_ray_direction(&self) -> Vec3 {
                self.cx.world_ray_direction()
            }
            /// Least `t`, as passed to trace.
            #[inline(always)]
            pub fn ray_tmin(&self) -> f32 {
                self.cx.ray_tmin()
            }
            /// Time, as passed to trace; 0 in a pipeline without motion.
            #[inline(always)]
            pub fn ray_time(&self) -> f32 {
                self.cx.ray_time()
            }
            /// Flags, as passed to trace.
            #[inline(always)]
            pub fn ray_flags(&self) -> RayFlags {
                // SAFETY: they are those of a `Ray`.
                unsafe { RayFlags::from_bits(self.cx.ray_flags()) }
            }
            /// Visibility mask, as passed to trace.
            #[inline(always)]
            pub fn ray_visibility_mask(&self) -> u8 {
                self.cx.ray_mask() as u8
            }
        }
    )*};
}
ray_queries!(Intersection<P, A>, AnyHit<P, A>, ClosestHit<P, A>, Miss<P>);

macro_rules! ray_tmax {
    ($($(#[$doc:meta])* $name:ident<P $(, $a:ident)?> $call:ident;)*) => {$(
        impl<P $(, $a)?> $name<P $(, $a)?> {
            $(#[$doc])*
            #[inline(always)]
            pub fn ray_tmax(&self) -> f32 {
                self.cx.$call()
            }
        }
    )*};
}
ray_tmax! {
    /// The nearest `t` accepted so far, else the `tmax` passed to trace; shrinks while this program reports.
    Intersection<P, A> interval_end;
    /// The candidate's `t`.
    AnyHit<P, A> ray_tmax;
    /// The hit's `t`.
    ClosestHit<P, A> ray_tmax;
    /// The `tmax` passed to trace.
    Miss<P> ray_tmax;
}

impl<P, A: Attributes> Intersection<P, A> {
    /// Reports a hit at `t` (guide 13.4).
    ///
    /// True if it was accepted: inside the current interval and not ignored by the any-hit program. `kind` is 0 to 127;
    /// its eighth bit is left out, on both machines, and ends the launch on [`Device::cpu_checked`].
    ///
    /// [`Device::cpu_checked`]: https://docs.rs/optix-host/latest/optix_host/struct.Device.html#method.cpu_checked
    ///
    /// The any-hit program runs meanwhile, on the ray's payload as the trace call, earlier reports and earlier intersection
    /// programs left it. What this program returns is stored when it returns: over what the any-hit programs of its reports
    /// wrote to the same fields. To count both, use two fields, or leave the field to the any-hit program.
    #[inline(always)]
    pub fn report(&self, t: f32, kind: u8, attributes: A) -> bool {
        let mut words = WordBuffer::ZERO;
        attributes.store(part_mut(&mut words.0, 0, A::WORDS));
        self.cx.report(t, kind as u32, A::WORDS, &words)
    }
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
    fn run(cx: &RayGen<P>, record: &Self::Record);
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
    fn run(cx: &Miss<P>, record: &Self::Record, input: R::AtMiss) -> R::FromMiss;
}

/// A closest-hit program for hits `A` on material `Rec`, rays with payload `R`; made by `#[closesthit]`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't be the closest-hit program of material `{Rec}` for ray type `{R}` in pipeline `{P}`",
    label = "its context, record, payload or result is another's",
    note = "expected `#[closesthit] fn(hit: &ClosestHit<{P}, {A}>, [record: &{Rec}], [ray: {R}AtClosestHit]) -> {R}FromClosestHit`; leave out what the payload does not have"
)]
pub trait ClosestHitProgram<P: Pipeline, A: Attributes, Rec: SbtRecord, R: Payload> {
    /// Calls the function.
    fn run(cx: &ClosestHit<P, A>, record: &Rec, input: R::AtClosestHit) -> R::FromClosestHit;
}

/// An any-hit program for hits `A` on material `Rec`, rays with payload `R`; made by `#[anyhit]`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` can't be the any-hit program of material `{Rec}` for ray type `{R}` in pipeline `{P}`",
    label = "its context, record, payload or result is another's",
    note = "expected `#[anyhit] fn(hit: &AnyHit<{P}, {A}>, [record: &{Rec}], [ray: {R}AtAnyHit]) -> Decision`, or `-> (Decision, {R}FromAnyHit)` where it writes the payload"
)]
pub trait AnyHitProgram<P: Pipeline, A: Attributes, Rec: SbtRecord, R: Payload> {
    /// Calls the function.
    fn run(cx: &AnyHit<P, A>, record: &Rec, input: R::AtAnyHit) -> (Decision, R::FromAnyHit);
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
    fn run(cx: &Intersection<P, Self::Attributes>, record: &Rec, input: R::AtIntersection) -> R::FromIntersection;
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
        cx: &DirectCallable<P>,
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
        cx: &ContinuationCallable<P>,
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
    fn run(cx: &Exception<P>, record: &Self::Record);
}

/// Reads the record; its type was checked by `pipeline!` and its layout is [`DeviceData`]'s.
///
/// # Safety
/// The running program's record holds a `Rec`.
#[inline(always)]
unsafe fn record<Rec: DeviceData>(cx: &Cx) -> &Rec {
    if size_of::<Rec>() == 0 {
        // SAFETY: nothing is read; the address only has to be aligned.
        return unsafe { core::ptr::NonNull::dangling().as_ref() };
    }
    // SAFETY: the caller's; OptiX aligns record data to 16 bytes (guide 7.2), which `RecordLayout` checks to be enough.
    unsafe { &*cx.record().cast::<Rec>() }
}
