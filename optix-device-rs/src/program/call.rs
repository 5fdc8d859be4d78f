//! What takes the context of the program that calls: callables, and who may call them (guide 15.1).

use super::{AnyHit, ClosestHit, ContinuationCallable, DirectCallable, Exception, Intersection, Miss, RayGen};
use crate::callable::{Callable, Continuation, Direct};
use crate::machine::Cx;
use crate::words::Words;

/// Only this crate asks a context for its machine, and has contexts, since nobody else can name this: programs would get round
/// what a context allows.
pub struct Here(pub(crate) ());

/// The context of a program, of any kind.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not the context of a program",
    label = "expected the context of the program that asks: its first argument",
    note = "instances and triangles are read by running programs: pass the context on, as in `frame.instances().get(rg, index)`"
)]
pub trait Context {
    #[doc(hidden)]
    fn machine(&self, _: Here) -> &Cx;
}

/// The context of a program that may call direct callables.
#[diagnostic::on_unimplemented(
    message = "direct callables can't be called from `{Self}`",
    label = "the first argument is the context of the program that calls",
    note = "every kind of program but exception programs calls direct callables (guide 15.1): pass the context on, as in `record.texture.call(hit, uv)`"
)]
pub trait CallsDirect {
    #[doc(hidden)]
    fn machine(&self, _: Here) -> &Cx;
}

/// The context of a program that may call continuation callables.
#[diagnostic::on_unimplemented(
    message = "continuation callables can't be called from `{Self}`",
    label = "only ray-generation, closest-hit and miss programs and continuation callables call them (guide 15.1)",
    note = "if the target traces no rays make it a direct callable: `#[direct_callable]`, and `Callable<F>` in place of `Callable<F, Continuation>`"
)]
pub trait CallsContinuation {
    #[doc(hidden)]
    fn machine(&self, _: Here) -> &Cx;
}

macro_rules! may_call {
    ($bound:ident: $($name:ident<P $(, $a:ident)?>),*) => {$(
        impl<P $(, $a)?> $bound for $name<P $(, $a)?> {
            #[inline(always)]
            fn machine(&self, _: Here) -> &Cx {
                &self.cx
            }
        }
    )*};
}
may_call!(Context: RayGen<P>, Intersection<P, A>, AnyHit<P, A>, ClosestHit<P, A>, Miss<P>, Exception<P>, DirectCallable<P>, ContinuationCallable<P>);
may_call!(CallsDirect: RayGen<P>, Intersection<P, A>, AnyHit<P, A>, ClosestHit<P, A>, Miss<P>, DirectCallable<P>, ContinuationCallable<P>);
may_call!(CallsContinuation: RayGen<P>, ClosestHit<P, A>, Miss<P>, ContinuationCallable<P>);

macro_rules! call {
    ($kind:ty, $bound:ident, $call:ident: $(($($argument:ident: $type:ident)*))*) => {$(
        impl<$($type: Words,)* R: Words> Callable<fn($($type),*) -> R, $kind> {
            /// Calls it; `context` is that of the calling program.
            #[inline(always)]
            #[allow(clippy::too_many_arguments, reason = "those of the callable")]
            pub fn call<C: $bound>(self, context: &C, $($argument: $type),*) -> R {
                // SAFETY: the record is there, with this signature and kind (`Callable::from_raw`).
                unsafe { context.machine(Here(())).$call::<fn($($type),*) -> R>(self.to_raw(), ($($argument,)*)) }
            }
        }
    )*};
}
macro_rules! calls {
    ($($arguments:tt)*) => {
        call!(Direct, CallsDirect, call_direct: $($arguments)*);
        call!(Continuation, CallsContinuation, call_continuation: $($arguments)*);
    };
}
calls! {
    ()
    (a: A)
    (a: A b: B)
    (a: A b: B c: C0)
    (a: A b: B c: C0 d: D)
    (a: A b: B c: C0 d: D e: E)
    (a: A b: B c: C0 d: D e: E f: F)
    (a: A b: B c: C0 d: D e: E f: F g: G)
    (a: A b: B c: C0 d: D e: E f: F g: G h: H)
}
