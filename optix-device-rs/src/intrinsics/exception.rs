//! Throwing, and what an exception program is told (guide 13.14).

use super::Invocation;
use crate::check::{HasException, MayThrow};
use crate::exception::{MAX_DETAILS, Raised, Thrower, ThrownBy, UserException};
#[cfg(not(target_arch = "nvptx64"))]
use crate::host::{ExceptionState, end};
use crate::pipeline::Pipeline;
use crate::words::{WordBuffer, part};
#[cfg(target_arch = "nvptx64")]
use core::arch::asm;
use core::ffi::CStr;
#[cfg(target_arch = "nvptx64")]
use core::ffi::c_char;
use core::marker::PhantomData;
#[cfg(not(target_arch = "nvptx64"))]
use core::panic::Location;
#[cfg(not(target_arch = "nvptx64"))]
use std::ffi::CString;

device_functions! {
    in exception else HasException {
        /// The code: 0 to 2^30 - 1 for what programs throw, negative for OptiX's own.
        "optixGetExceptionCode"
        fn exception_code(&self) -> i32 {
            ptx { get_u32!("_optix_get_exception_code").cast_signed() }
            host { self.frame().exception.code }
        }

        /// Where it was thrown, as text; none where that is not known. OptiX knows of user exceptions in PTX with line
        /// information.
        "optixGetExceptionLineInfo"
        fn line_info(&self) -> Option<&CStr> {
            ptx {
                let address = get_u64!("_optix_get_exception_line_info");
                // SAFETY: null, or a text with a NUL at its end that lives as long as the pipeline.
                (address != 0).then(|| unsafe { CStr::from_ptr(address as *const c_char) })
            }
            host { self.frame().exception.line.as_deref() }
        }
    }
}

methods! {
    in exception {
        /// What happened.
        #[inline(always)]
        pub fn raised(&self) -> Raised<P::Exception>
        where
            P: Pipeline,
        {
            let details = self.invocation.exception_details(<P::Exception as UserException>::DETAILS);
            // SAFETY: the pipeline's programs throw nothing but its exception type (`Throws`).
            unsafe { Raised::decode(self.exception_code(), part(&details.0, 0, MAX_DETAILS)) }
        }
    }
    others {
        #[doc(hidden)]
        pub fn raised(&self)
        where
            Self: HasException,
        {
            unreachable!()
        }
    }
}

methods! {
    in running {
        /// Ends this launch index with an exception: nothing of it runs any more but the pipeline's exception program.
        ///
        /// The pipeline says what its programs may throw: `throws: Fault`.
        ///
        /// On the CPU that is done by unwinding. A program that catches it (`catch_unwind`) takes nothing back: the index
        /// ends at its next trace call, call, report, throw or use of a view, or when it returns. Destructors run; what they trace or call
        /// runs no program and gives zeros, and one that throws or panics ends the process, as it does whenever Rust unwinds.
        #[inline(always)]
        #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
        pub fn throw<E: ThrownBy<P>>(&self, exception: E) -> ! {
            exception.throw(Throw::<E> { invocation: &self.invocation, exception: PhantomData })
        }
    }
    others {
        #[doc(hidden)]
        pub fn throw<E>(&self, _: E) -> !
        where
            Self: MayThrow,
        {
            unreachable!()
        }
    }
}

/// Throws an `E` from a program.
struct Throw<'c, E> {
    invocation: &'c Invocation,
    exception: PhantomData<E>,
}

impl<E: UserException> Thrower for Throw<'_, E> {
    #[inline(always)]
    #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
    fn throw<const CODE: u32>(self, details: &[u32; MAX_DETAILS]) -> ! {
        self.invocation.throw::<CODE>(E::DETAILS, details)
    }
}

impl Invocation {
    /// Ends the launch index with a user exception. `count` is a constant at every call.
    ///
    /// On the device the code is in the text, so that calls with different codes are never joined into one: OptiX refuses a code
    /// that is no constant.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
    pub fn throw<const CODE: u32>(&self, count: usize, details: &[u32; MAX_DETAILS]) -> ! {
        #[cfg(target_arch = "nvptx64")]
        {
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
        #[cfg(not(target_arch = "nvptx64"))]
        {
            let _ = count;
            // It is the running program's, whose pipeline is told.
            let _ = self.frame();
            let at = Location::caller();
            let line = CString::new(std::format!("{}:{}", at.file(), at.line())).ok();
            // SAFETY: `Throw`, which the context makes, is told code and details by an exception of the pipeline's type.
            unsafe { end::throw(ExceptionState { code: CODE.cast_signed(), details: *details, line }) }
        }
    }

    /// The first `count` details; the others are zero on the device.
    ///
    /// There each read is followed by a fence. Without it, values that are used behind branches only are read from misaligned
    /// addresses of local memory, which ends the launch (seen with driver 580.159): its compiler seems to move such reads, and
    /// a fence, like a use before the branch, holds them.
    #[inline(always)]
    pub fn exception_details(&self, count: usize) -> WordBuffer {
        body! {
            ptx {
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
            host {
                let _ = count;
                let mut words = WordBuffer::ZERO;
                words.0[..MAX_DETAILS].copy_from_slice(&self.frame().exception.details);
                words
            }
        }
    }
}
