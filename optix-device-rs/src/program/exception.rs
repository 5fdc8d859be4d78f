//! Throwing, and what an exception program is told (guide 13.14).

use super::{AnyHit, ClosestHit, ContinuationCallable, DirectCallable, Exception, Intersection, Miss, RayGen};
use crate::exception::{MAX_DETAILS, Raised, Thrower, ThrownBy, UserException};
use crate::machine::Cx;
use crate::pipeline::Pipeline;
use crate::words::part;
use core::ffi::CStr;
use core::marker::PhantomData;

/// Throws an `E` from a program.
struct Throw<'c, E> {
    cx: &'c Cx,
    exception: PhantomData<E>,
}

impl<E: UserException> Thrower for Throw<'_, E> {
    #[inline(always)]
    #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
    fn throw<const CODE: u32>(self, details: &[u32; MAX_DETAILS]) -> ! {
        self.cx.throw::<CODE>(E::DETAILS, details)
    }
}

macro_rules! may_throw {
    ($($name:ident<P $(, $a:ident)?>),*) => {$(
        impl<P $(, $a)?> $name<P $(, $a)?> {
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
                exception.throw(Throw::<E> { cx: &self.cx, exception: PhantomData })
            }
        }
    )*};
}
may_throw!(
    RayGen<P>, Intersection<P, A>, AnyHit<P, A>, ClosestHit<P, A>, Miss<P>, DirectCallable<P>, ContinuationCallable<P>
);

impl<P: Pipeline> Exception<P> {
    /// What happened.
    #[inline(always)]
    pub fn raised(&self) -> Raised<P::Exception> {
        let details = self.cx.exception_details(<P::Exception as UserException>::DETAILS);
        // SAFETY: the pipeline's programs throw nothing but its exception type (`Throws`).
        unsafe { Raised::decode(self.cx.exception_code(), part(&details.0, 0, MAX_DETAILS)) }
    }
}

impl<P> Exception<P> {
    /// The code: 0 to 2^30 - 1 for what programs throw, negative for OptiX's own.
    #[inline(always)]
    pub fn exception_code(&self) -> i32 {
        self.cx.exception_code()
    }

    /// Where it was thrown, as text; none where that is not known. OptiX knows of user exceptions in PTX with line
    /// information.
    #[inline(always)]
    pub fn line_info(&self) -> Option<&CStr> {
        self.cx.exception_line()
    }
}
