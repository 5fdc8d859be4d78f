//! What stands in `pipeline!` for a function without an attribute: number `N` of them fits everywhere, so that `check::is_program`
//! is all that is said of it.

use super::*;
use crate::check::NoHits;
use crate::payload::Part;

#[diagnostic::do_not_recommend]
impl<const N: usize, P: Pipeline> RayGenProgram<P> for [(); N] {
    type Record = ();
    fn run(_: &RayGen<P>, _: &()) {}
}

#[diagnostic::do_not_recommend]
impl<const N: usize, P: Pipeline> ExceptionProgram<P> for [(); N] {
    type Record = ();
    fn run(_: &Exception<P>, _: &()) {}
}

#[diagnostic::do_not_recommend]
impl<const N: usize, P: Pipeline, R: Payload> MissProgram<P, R> for [(); N] {
    type Record = ();
    fn run(_: &Miss<P>, _: &(), _: R::AtMiss) -> R::FromMiss {
        nothing()
    }
}

#[diagnostic::do_not_recommend]
impl<const N: usize, P: Pipeline, A: Attributes, Rec: SbtRecord, R: Payload> ClosestHitProgram<P, A, Rec, R>
    for [(); N]
{
    fn run(_: &ClosestHit<P, A>, _: &Rec, _: R::AtClosestHit) -> R::FromClosestHit {
        nothing()
    }
}

#[diagnostic::do_not_recommend]
impl<const N: usize, P: Pipeline, A: Attributes, Rec: SbtRecord, R: Payload> AnyHitProgram<P, A, Rec, R> for [(); N] {
    fn run(_: &AnyHit<P, A>, _: &Rec, _: R::AtAnyHit) -> (Decision, R::FromAnyHit) {
        (Decision::Accept, nothing())
    }
}

#[diagnostic::do_not_recommend]
impl<const N: usize, P: Pipeline, Rec: SbtRecord, R: Payload> IntersectionProgram<P, Rec, R> for [(); N] {
    type Attributes = NoHits;
    fn run(_: &Intersection<P, NoHits>, _: &Rec, _: R::AtIntersection) -> R::FromIntersection {
        nothing()
    }
}

#[diagnostic::do_not_recommend]
impl<const N: usize, P: Pipeline> DirectCallableProgram<P> for [(); N] {
    type Record = ();
    type Signature = fn();
    fn run(_: &DirectCallable<P>, _: &(), (): ()) {}
}

#[diagnostic::do_not_recommend]
impl<const N: usize, P: Pipeline> ContinuationCallableProgram<P> for [(); N] {
    type Record = ();
    type Signature = fn();
    fn run(_: &ContinuationCallable<P>, _: &(), (): ()) {}
}

/// Never called: such a pipeline does not compile.
fn nothing<T: Part>() -> T {
    unreachable!()
}
