//! Throwing, and what an exception program asks (guide 13.14).

use super::Cx;
use crate::exception::MAX_DETAILS;
use crate::words::WordBuffer;
use core::arch::asm;
use core::ffi::{CStr, c_char};

impl Cx {
    /// Ends the launch index with a user exception. `count` is a constant at every call.
    ///
    /// The code is in the text, so that calls with different codes are never joined into one: OptiX refuses a code that is
    /// no constant.
    #[inline(always)]
    pub fn throw<const CODE: u32>(&self, count: usize, details: &[u32; MAX_DETAILS]) -> ! {
        let [d0, d1, d2, d3, d4, d5, d6, d7] = *details;
        macro_rules! arm {
            ($count:expr, [$($used:ident)*] [$($unused:ident)*]) => {
                if $count == count!($($used)*) {
                    // SAFETY: the context may throw, and the pipeline's options allow user exceptions.
                    unsafe {
                        asm!(
                            concat!(
                                "{{ .reg .b32 code; mov.b32 code, {code}; ",
                                "call _optix_throw_exception_", arm!(@n $($used)*), ", (code",
                                $(", {", stringify!($used), "}",)*
                                "); }}"
                            ),
                            code = const CODE,
                            $($used = in(reg32) $used,)*
                            options(nostack, preserves_flags)
                        )
                    };
                }
            };
            (@n) => { "0" };
            (@n d0) => { "1" };
            (@n d0 d1) => { "2" };
            (@n d0 d1 d2) => { "3" };
            (@n d0 d1 d2 d3) => { "4" };
            (@n d0 d1 d2 d3 d4) => { "5" };
            (@n d0 d1 d2 d3 d4 d5) => { "6" };
            (@n d0 d1 d2 d3 d4 d5 d6) => { "7" };
            (@n d0 d1 d2 d3 d4 d5 d6 d7) => { "8" };
        }
        by_count!(arm, count, [] [d0 d1 d2 d3 d4 d5 d6 d7]);
        super::trap()
    }

    #[inline(always)]
    pub fn exception_code(&self) -> i32 {
        get_u32!("_optix_get_exception_code").cast_signed()
    }

    /// The first `count` details; the others are zero.
    ///
    /// Each read is followed by a fence. Without it, values that are used behind branches only are read from misaligned
    /// addresses of local memory, which ends the launch (seen with driver 580.159): its compiler seems to move such reads, and
    /// a fence, like a use before the branch, holds them.
    #[inline(always)]
    pub fn exception_details(&self, count: usize) -> WordBuffer {
        let mut words = WordBuffer::ZERO;
        macro_rules! get {
            ($($i:literal)*) => {$(
                if count > $i {
                    // SAFETY: an exception program may ask, and a fence has no effect on values.
                    unsafe {
                        asm!(
                            concat!("call ({v}), _optix_get_exception_detail_", $i, ", (); membar.cta;"),
                            v = out(reg32) words.0[$i],
                            options(nomem, nostack, preserves_flags)
                        )
                    };
                }
            )*};
        }
        get!(0 1 2 3 4 5 6 7);
        words
    }

    #[inline(always)]
    pub fn exception_line(&self) -> Option<&CStr> {
        let address: u64;
        // SAFETY: pure query.
        unsafe {
            asm!(
                "call ({a}), _optix_get_exception_line_info, ();",
                a = out(reg64) address,
                options(pure, nomem, nostack, preserves_flags)
            )
        };
        // SAFETY: null, or a text with a NUL at its end that lives as long as the pipeline.
        (address != 0).then(|| unsafe { CStr::from_ptr(address as *const c_char) })
    }
}
