//! The bodies of entry points: `pipeline!` makes one call to one of these for each program, on either machine.
//!
//! They take the program as a function, not as a type with a bound, so that a program that does not fit is reported once,
//! with its own message.

use super::*;
use crate::payload::Part;
use crate::pipeline::HasRay;

/// # Safety
/// `cx` is of a ray-generation program whose record is the program's.
#[inline(always)]
pub unsafe fn raygen<P: Pipeline, Rec: SbtRecord>(cx: Cx, run: impl Fn(&RayGen<P>, &Rec)) -> Decision {
    // SAFETY: the caller's.
    run(&RayGen::new(cx), unsafe { record::<Rec>(&cx) });
    Decision::Accept
}

/// # Safety
/// `cx` is of a miss program whose record is the program's.
#[inline(always)]
pub unsafe fn miss<P: HasRay<R>, R: Payload, Rec: SbtRecord>(
    cx: Cx,
    run: impl Fn(&Miss<P>, &Rec, R::AtMiss) -> R::FromMiss,
) -> Decision {
    cx.set_payload_type(P::PAYLOAD_TYPE);
    let input = R::AtMiss::load(&cx.payload(R::AtMiss::MASK));
    // SAFETY: the caller's.
    let output = run(&Miss::new(cx), unsafe { record::<Rec>(&cx) }, input);
    give(&cx, output);
    Decision::Accept
}

/// # Safety
/// `cx` is of a closest-hit program whose record is a `Rec` and whose hits are `A`.
#[inline(always)]
pub unsafe fn closesthit<P, A, Rec, R>(
    cx: Cx,
    run: impl Fn(&ClosestHit<P, A>, &Rec, R::AtClosestHit) -> R::FromClosestHit,
) -> Decision
where
    P: HasRay<R>,
    A: Attributes,
    Rec: SbtRecord,
    R: Payload,
{
    cx.set_payload_type(P::PAYLOAD_TYPE);
    let input = R::AtClosestHit::load(&cx.payload(R::AtClosestHit::MASK));
    // SAFETY: the caller's.
    let output = run(&ClosestHit::new(cx), unsafe { record::<Rec>(&cx) }, input);
    give(&cx, output);
    Decision::Accept
}

/// # Safety
/// `cx` is of an any-hit program whose record is a `Rec` and whose hits are `A`.
#[inline(always)]
pub unsafe fn anyhit<P, A, Rec, R>(
    cx: Cx,
    run: impl Fn(&AnyHit<P, A>, &Rec, R::AtAnyHit) -> (Decision, R::FromAnyHit),
) -> Decision
where
    P: HasRay<R>,
    A: Attributes,
    Rec: SbtRecord,
    R: Payload,
{
    cx.set_payload_type(P::PAYLOAD_TYPE);
    let input = R::AtAnyHit::load(&cx.payload(R::AtAnyHit::MASK));
    // SAFETY: the caller's.
    let (decision, output) = run(&AnyHit::new(cx), unsafe { record::<Rec>(&cx) }, input);
    give(&cx, output);
    #[cfg(target_arch = "nvptx64")]
    match decision {
        Decision::Accept => {}
        Decision::Ignore => cx.ignore_intersection(),
        Decision::Terminate => cx.terminate_ray(),
    }
    decision
}

/// # Safety
/// `cx` is of an intersection program whose record is a `Rec`.
#[inline(always)]
pub unsafe fn intersection<P, A, Rec, R>(
    cx: Cx,
    run: impl Fn(&Intersection<P, A>, &Rec, R::AtIntersection) -> R::FromIntersection,
) -> Decision
where
    P: HasRay<R>,
    Rec: SbtRecord,
    R: Payload,
{
    cx.set_payload_type(P::PAYLOAD_TYPE);
    let input = R::AtIntersection::load(&cx.payload(R::AtIntersection::MASK));
    // SAFETY: the caller's.
    let output = run(&Intersection::new(cx), unsafe { record::<Rec>(&cx) }, input);
    give(&cx, output);
    Decision::Accept
}

#[inline(always)]
fn give<T: Part>(cx: &Cx, part: T) {
    let mut words = WordBuffer::ZERO;
    part.store(&mut words);
    cx.set_payload(T::MASK, &words);
}
