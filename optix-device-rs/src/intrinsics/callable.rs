//! Calls of callables, and who may call them; and what any program may do with its context (guide 15).
//!
//! OptiX gives the address of the callable's function; the call is an ordinary call through a pointer. Its type is that
//! of the entry which `pipeline!` makes for the program, and one compilation makes both: so caller and callable agree on
//! how arguments and result are passed.

use super::{Invocation, Private};
#[cfg(target_arch = "nvptx64")]
use crate::callable::Packed;
use crate::callable::{Callable, Continuation, Direct, Signature};
#[cfg(not(target_arch = "nvptx64"))]
use crate::host::{CallableCall, end};
use crate::words::Words;
#[cfg(not(target_arch = "nvptx64"))]
use crate::words::{WordBuffer, part, part_mut};
#[cfg(not(target_arch = "nvptx64"))]
use core::any::TypeId;
#[cfg(target_arch = "nvptx64")]
use core::arch::asm;

/// The context of a program, of any kind.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not the context of a program",
    label = "expected the context of the program that asks: its first argument",
    note = "instances and triangles are read by running programs: pass the context on, as in `frame.instances().get(rg, index)`"
)]
pub trait Context {
    #[doc(hidden)]
    fn invocation(&self, _: Private) -> &Invocation;
}

/// The context of a program that may call direct callables.
#[diagnostic::on_unimplemented(
    message = "direct callables can't be called from `{Self}`",
    label = "the first argument is the context of the program that calls",
    note = "every kind of program but exception programs calls direct callables (guide 15.1): pass the context on, as in `record.texture.call(hit, uv)`"
)]
pub trait CallsDirect {
    #[doc(hidden)]
    fn invocation(&self, _: Private) -> &Invocation;
}

/// The context of a program that may call continuation callables.
#[diagnostic::on_unimplemented(
    message = "continuation callables can't be called from `{Self}`",
    label = "only ray-generation, closest-hit and miss programs and continuation callables call them (guide 15.1)",
    note = "if the target traces no rays make it a direct callable: `#[direct_callable]`, and `Callable<F>` in place of `Callable<F, Continuation>`"
)]
pub trait CallsContinuation {
    #[doc(hidden)]
    fn invocation(&self, _: Private) -> &Invocation;
}

/// Implements a trait for the contexts of a group.
macro_rules! has_invocation {
    ([$($may:ident<P $(, $a:ident)?>),*] $others:tt $bound:ident) => {$(
        impl<P $(, $a)?> $bound for crate::program::$may<P $(, $a)?> {
            #[inline(always)]
            fn invocation(&self, _: Private) -> &Invocation {
                &self.invocation
            }
        }
    )*};
}
group! { anywhere has_invocation Context }
group! { running has_invocation CallsDirect }
group! { tracing has_invocation CallsContinuation }

macro_rules! call {
    ($kind:ty, $bound:ident, $call:ident: $(($($argument:ident: $type:ident)*))*) => {$(
        impl<$($type: Words,)* R: Words> Callable<fn($($type),*) -> R, $kind> {
            /// Calls it; `context` is that of the calling program.
            #[inline(always)]
            #[allow(clippy::too_many_arguments, reason = "those of the callable")]
            pub fn call<C: $bound>(self, context: &C, $($argument: $type),*) -> R {
                // SAFETY: the record is there, with this signature and kind (`Callable::from_raw`).
                unsafe { context.invocation(Private(())).$call::<fn($($type),*) -> R>(self.to_raw(), ($($argument,)*)) }
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

/// How callables are called: all arguments as one tuple.
#[cfg(target_arch = "nvptx64")]
type Function<F> = extern "C" fn(Packed<<F as Signature>::Arguments>) -> Packed<<F as Signature>::Result>;

macro_rules! invoke {
    ($($(#[$doc:meta])* $name:ident: $intrinsic:literal, $continuation:literal;)*) => {$(
        $(#[$doc])*
        #[inline(always)]
        pub unsafe fn $name<F: Signature>(&self, index: u32, arguments: F::Arguments) -> F::Result {
            body! {
                ptx {
                    let address: u64;
                    // SAFETY: the record is there (the caller's), and the caller's context may call it.
                    unsafe {
                        asm!(
                            concat!("call ({a}), ", $intrinsic, ", ({i});"),
                            a = out(reg64) address,
                            i = in(reg32) index,
                            options(nomem, nostack, preserves_flags)
                        )
                    };
                    // SAFETY: the address is that of the entry of a callable with signature `F`, which has this type.
                    let function = unsafe { core::mem::transmute::<*const (), Function<F>>(address as *const ()) };
                    function(Packed(arguments)).0
                }
                host { self.call::<F>($continuation, index, arguments) }
            }
        }
    )*};
}

impl Invocation {
    invoke! {
        /// Calls the direct callable of record `index`.
        ///
        /// # Safety
        /// The callables section has that record, of a direct callable with signature `F`; on the host the executor looks.
        call_direct: "_optix_call_direct_callable", false;
        /// Calls the continuation callable of record `index`.
        ///
        /// # Safety
        /// The callables section has that record, of a continuation callable with signature `F`; on the host the executor looks.
        call_continuation: "_optix_call_continuation_callable", true;
    }

    #[cfg(not(target_arch = "nvptx64"))]
    fn call<F: Signature>(&self, continuation: bool, number: u32, arguments: F::Arguments) -> F::Result {
        let mut words = WordBuffer::ZERO;
        arguments.store(part_mut(&mut words.0, 0, F::Arguments::COUNT));
        let call = CallableCall { number, continuation, signature: TypeId::of::<F>() };
        if end::goes_on() {
            self.frame().executor.call(&call, &mut words);
        } else {
            words = WordBuffer::ZERO;
        }
        // SAFETY: the executor compares the signatures, and the callable's entry stored what it returned (`entry::result`);
        // where none ran, they are zeros.
        unsafe { F::Result::load(part(&words.0, 0, F::Result::COUNT)) }
    }
}
