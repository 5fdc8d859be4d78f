//! The two halves of an entry point, around the call of the program: `pipeline!` writes that call itself, on either
//! machine, so that a program that does not fit is reported once and with its own message.

use super::*;
#[cfg(not(target_arch = "nvptx64"))]
use crate::payload::word_mask;
use crate::payload::{Part, Transport};
use crate::pipeline::HasRay;
use crate::words::WordBuffer;
#[cfg(not(target_arch = "nvptx64"))]
use crate::words::{Words, part, part_mut};

/// What a ray-generation program gets.
///
/// # Safety
/// `invocation` is of a ray-generation program whose record is a `Rec`.
#[inline(always)]
pub unsafe fn raygen<P: Pipeline, Rec: SbtRecord>(invocation: &Invocation) -> (RayGen<P>, &Rec) {
    // SAFETY: the caller's.
    (RayGen::new(*invocation), unsafe { record::<Rec>(invocation) })
}

/// What an exception program gets.
///
/// # Safety
/// `invocation` is of an exception program whose record is a `Rec`.
#[inline(always)]
pub unsafe fn exception<P: Pipeline, Rec: SbtRecord>(invocation: &Invocation) -> (Exception<P>, &Rec) {
    // SAFETY: the caller's.
    (Exception::new(*invocation), unsafe { record::<Rec>(invocation) })
}

macro_rules! callable_entries {
    ($($name:ident: $context:ident, $what:literal;)*) => {$(
        #[doc = concat!("What a ", $what, " gets, besides its arguments.")]
        ///
        /// # Safety
        #[doc = concat!("`invocation` is of a ", $what, " whose record is a `Rec`.")]
        #[inline(always)]
        pub unsafe fn $name<P: Pipeline, Rec: SbtRecord>(invocation: &Invocation) -> ($context<P>, &Rec) {
            // SAFETY: the caller's.
            ($context::new(*invocation), unsafe { record::<Rec>(invocation) })
        }
    )*};
}
callable_entries! {
    direct_callable: DirectCallable, "direct callable";
    continuation_callable: ContinuationCallable, "continuation callable";
}

/// The arguments of a call, on the host: on the device they are the entry's.
///
/// # Safety
/// `invocation` is of a callable with signature `F`.
#[cfg(not(target_arch = "nvptx64"))]
pub unsafe fn arguments<F: Signature>(invocation: &Invocation) -> F::Arguments {
    let count = F::Arguments::COUNT;
    // SAFETY: the caller of the callable stored them.
    unsafe { F::Arguments::load(part(&invocation.payload(word_mask(0, count)).0, 0, count)) }
}

/// Puts what a callable returned where its caller takes it, on the host: on the device the entry returns it.
#[cfg(not(target_arch = "nvptx64"))]
pub fn result<F: Signature>(invocation: &Invocation, result: F::Result) {
    let mut words = WordBuffer::ZERO;
    result.store(part_mut(&mut words.0, 0, F::Result::COUNT));
    invocation.set_payload(word_mask(0, F::Result::COUNT), &words);
}

/// What a miss program gets.
///
/// # Safety
/// `invocation` is of a miss program whose record is a `Rec`.
#[inline(always)]
pub unsafe fn miss<P: HasRay<R>, R: Payload, Rec: SbtRecord>(invocation: &Invocation) -> (Miss<P>, &Rec, R::AtMiss) {
    let input = take::<P, R, R::AtMiss>(invocation);
    // SAFETY: the caller's.
    (Miss::new(*invocation), unsafe { record::<Rec>(invocation) }, input)
}

macro_rules! hit_entries {
    ($($name:ident: $context:ident, $part:ident, $what:literal;)*) => {$(
        #[doc = concat!("What ", $what, " program gets.")]
        ///
        /// # Safety
        #[doc = concat!("`invocation` is of ", $what, " program whose record is a `Rec` and whose hits are `A`.")]
        #[inline(always)]
        pub unsafe fn $name<P: HasRay<R>, A, Rec: SbtRecord, R: Payload>(invocation: &Invocation) -> ($context<P, A>, &Rec, R::$part) {
            let input = take::<P, R, R::$part>(invocation);
            // SAFETY: the caller's.
            ($context::new(*invocation), unsafe { record::<Rec>(invocation) }, input)
        }
    )*};
}
hit_entries! {
    closesthit: ClosestHit, AtClosestHit, "a closest-hit";
    anyhit: AnyHit, AtAnyHit, "an any-hit";
    intersection: Intersection, AtIntersection, "an intersection";
}

/// The part of the payload that the program receives.
#[inline(always)]
fn take<P: HasRay<R>, R: Payload, T: Part>(invocation: &Invocation) -> T {
    invocation.set_payload_type(P::PAYLOAD_TYPE);
    invocation.takes(T::FIELDS);
    // SAFETY: the entries above ask for the part of their kind, and `invocation` is of a program of theirs; that its fields were
    // stored was proved (`Payload`).
    unsafe {
        if T::Transport::POINTER {
            T::load(T::Transport::memory(invocation))
        } else {
            T::load(&invocation.payload(T::MASK).0)
        }
    }
}

/// Puts what the program returned into the payload.
#[inline(always)]
pub fn give<T: Part>(invocation: &Invocation, part: T) -> Decision {
    invocation.gives(T::FIELDS);
    if T::Transport::POINTER {
        // SAFETY: `pipeline!` gives what the program of `invocation` returned, so it is that payload's.
        unsafe { T::Transport::give(invocation, &part) };
    } else {
        let mut registers = WordBuffer::ZERO;
        part.store(&mut registers.0);
        invocation.set_payload(T::MASK, &registers);
    }
    Decision::Accept
}

/// Puts what an any-hit program returned into the payload and does what it decided.
#[inline(always)]
pub fn decide<T: Part>(invocation: &Invocation, (decision, part): (Decision, T)) -> Decision {
    let _ = give(invocation, part);
    #[cfg(target_arch = "nvptx64")]
    match decision {
        Decision::Accept => {}
        Decision::Ignore | Decision::Terminate => {
            if let Decision::Terminate = decision {
                invocation.terminate_ray();
            }
            // Not reached after the other: a branch less than to the end.
            invocation.ignore_intersection();
        }
    }
    decision
}
