//! The bodies of entry points: `pipeline!` makes one call to each of these per program, on either machine.

use super::*;
use crate::payload::Part;
use crate::pipeline::HasRay;

/// # Safety
/// `cx` is of a ray-generation program whose record is the program's.
#[inline(always)]
pub unsafe fn raygen<P: Pipeline, Prog: RayGenProgram<P>>(cx: Cx) -> Decision {
    // SAFETY: the caller's.
    Prog::run(&RayGen::new(cx), unsafe { record::<Prog::Record>(&cx) });
    Decision::Accept
}

/// # Safety
/// `cx` is of a miss program whose record is the program's.
#[inline(always)]
pub unsafe fn miss<P: HasRay<R>, R: Payload, Prog: MissProgram<P, R>>(cx: Cx) -> Decision {
    cx.set_payload_type(P::PAYLOAD_TYPE);
    let input = R::AtMiss::load(&cx.payload(R::AtMiss::MASK));
    // SAFETY: the caller's.
    let output = Prog::run(&Miss::new(cx), unsafe { record::<Prog::Record>(&cx) }, input);
    give(&cx, output);
    Decision::Accept
}

/// # Safety
/// `cx` is of a closest-hit program whose record is a `Rec` and whose hits are `A`.
#[inline(always)]
pub unsafe fn closesthit<P, A, Rec, R, Prog>(cx: Cx) -> Decision
where
    P: HasRay<R>,
    A: Attributes,
    Rec: SbtRecord,
    R: Payload,
    Prog: ClosestHitProgram<P, A, Rec, R>,
{
    cx.set_payload_type(P::PAYLOAD_TYPE);
    let input = R::AtClosestHit::load(&cx.payload(R::AtClosestHit::MASK));
    // SAFETY: the caller's.
    let output = Prog::run(&ClosestHit::new(cx), unsafe { record::<Rec>(&cx) }, input);
    give(&cx, output);
    Decision::Accept
}

/// # Safety
/// `cx` is of an any-hit program whose record is a `Rec` and whose hits are `A`.
#[inline(always)]
pub unsafe fn anyhit<P, A, Rec, R, Prog>(cx: Cx) -> Decision
where
    P: HasRay<R>,
    A: Attributes,
    Rec: SbtRecord,
    R: Payload,
    Prog: AnyHitProgram<P, A, Rec, R>,
{
    cx.set_payload_type(P::PAYLOAD_TYPE);
    let input = R::AtAnyHit::load(&cx.payload(R::AtAnyHit::MASK));
    // SAFETY: the caller's.
    let (decision, output) = Prog::run(&AnyHit::new(cx), unsafe { record::<Rec>(&cx) }, input);
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
pub unsafe fn intersection<P, Rec, R, Prog>(cx: Cx) -> Decision
where
    P: HasRay<R>,
    Rec: SbtRecord,
    R: Payload,
    Prog: IntersectionProgram<P, Rec, R>,
{
    cx.set_payload_type(P::PAYLOAD_TYPE);
    let input = R::AtIntersection::load(&cx.payload(R::AtIntersection::MASK));
    // SAFETY: the caller's.
    let output = Prog::run(&Intersection::new(cx), unsafe { record::<Rec>(&cx) }, input);
    give(&cx, output);
    Decision::Accept
}

#[inline(always)]
fn give<T: Part>(cx: &Cx, part: T) {
    let mut words = WordBuffer::ZERO;
    part.store(&mut words);
    cx.set_payload(T::MASK, &words);
}
