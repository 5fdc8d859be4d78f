//! Throwing, and what an exception program is told (guide 13.14).

use super::{AnyHit, ClosestHit, ContinuationCallable, DirectCallable, Exception, Intersection, Miss, RayGen};
use crate::exception::{MAX_DETAILS, Raised, ThrownBy, UserException};
use crate::machine::Cx;
use crate::pipeline::Pipeline;
use crate::words::{WordBuffer, part, part_mut};
use core::ffi::CStr;

#[inline(always)]
#[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
fn throw<E: UserException>(cx: &Cx, exception: E) -> ! {
    let mut details = WordBuffer::ZERO;
    let code = exception.encode(part_mut(&mut details.0, 0, MAX_DETAILS));
    cx.throw(code, E::DETAILS, &details)
}

macro_rules! may_throw {
    ($($name:ident<P $(, $a:ident)?>),*) => {$(
        impl<P $(, $a)?> $name<P $(, $a)?> {
            /// Ends this launch index with an exception: nothing of it runs any more but the pipeline's exception program.
            ///
            /// The pipeline says what its programs may throw: `throws: Fault`.
            #[inline(always)]
            #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
            pub fn throw<E: ThrownBy<P>>(&self, exception: E) -> ! {
                throw(&self.cx, exception)
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
