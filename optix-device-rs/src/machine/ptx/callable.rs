//! Calls of callables (guide 15).
//!
//! OptiX gives the address of the callable's function; the call is an ordinary call through a pointer. Its type is that
//! of the entry which `pipeline!` makes for the program, and one compilation makes both: so caller and callable agree on
//! how arguments and result are passed.

use super::Cx;
use crate::callable::{Packed, Signature};
use core::arch::asm;

/// How callables are called: all arguments as one tuple.
type Function<F> = extern "C" fn(Packed<<F as Signature>::Arguments>) -> Packed<<F as Signature>::Result>;

macro_rules! call {
    ($($(#[$doc:meta])* $name:ident: $intrinsic:literal;)*) => {$(
        $(#[$doc])*
        #[inline(always)]
        pub unsafe fn $name<F: Signature>(&self, index: u32, arguments: F::Arguments) -> F::Result {
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
    )*};
}

impl Cx {
    call! {
        /// Calls the direct callable of record `index`.
        ///
        /// # Safety
        /// The callables section has that record, of a direct callable with signature `F`.
        call_direct: "_optix_call_direct_callable";
        /// Calls the continuation callable of record `index`.
        ///
        /// # Safety
        /// The callables section has that record, of a continuation callable with signature `F`.
        call_continuation: "_optix_call_continuation_callable";
    }
}
