//! Exceptions: what ends a launch index early, and the program that is told of it (guide 13.14).
//!
//! A pipeline says what its programs may throw, which program is told, or both: `throws: Fault, exception: report`. From
//! that the exception flags of the pipeline follow; one that says neither pays for nothing.
//!
//! ```
//! use optix_device_rs::prelude::*;
//!
//! /// What can go wrong.
//! #[derive(Clone, Copy, UserException)]
//! pub enum Fault {
//!     NotANumber { pixel: UVec2, light: Vec3 },
//!     Lost,
//! }
//! # #[launch_params] pub struct Frame { pub film: SliceMut2d<Vec4>, pub faults: SliceMut<u32> }
//!
//! #[raygen]
//! fn camera<P: Throws<Fault> + Pipeline<Params = Frame>>(rg: &RayGen<P>) {
//!     let pixel = rg.launch_index().xy();
//!     let light = rg.params().film().get(pixel).xyz();
//!     if light.is_nan() {
//!         rg.throw(Fault::NotANumber { pixel, light });
//!     }
//! }
//!
//! #[exception]
//! fn report<P: Pipeline<Params = Frame, Exception = Fault>>(ex: &Exception<P>) {
//!     let kind = match ex.raised() {
//!         Raised::User(Fault::NotANumber { .. }) => 1,
//!         Raised::User(Fault::Lost) => 2,
//!         Raised::StackOverflow => 3,
//!         Raised::TraceDepthExceeded => 4,
//!         _ => 5,
//!     };
//!     ex.params().faults().set(0, kind);
//! }
//! ```

use crate::layout::{Crossing, Layout};
use crate::pipeline::Throws;

/// The most words of details that an exception carries (guide 13.14).
pub const MAX_DETAILS: usize = 8;
/// User codes are below this (guide 13.14).
pub const MAX_CODE: u32 = 1 << 30;

/// What programs throw: an enum with `#[derive(UserException)]`, one code a variant, its fields the details.
///
/// # Safety
/// Codes are below [`MAX_CODE`] and details within [`MAX_DETAILS`].
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an exception that programs throw",
    label = "expected an enum with `#[derive(UserException)]`"
)]
pub unsafe trait UserException: Copy + 'static {
    /// The name, for messages.
    const NAME: &'static str;
    /// Words of details: the most of any variant.
    const DETAILS: usize;
    /// Code and name of each variant.
    const VARIANTS: &'static [(u32, &'static str)];
    /// How codes and details are made up.
    #[doc(hidden)]
    const LAYOUT: Layout = Layout::of("exception").number(Self::DETAILS);
    /// What a host and a device have to agree on.
    #[doc(hidden)]
    const CROSSING: Crossing = Crossing::exception::<Self>();
    /// Throws it: its code, and its details in the first of [`MAX_DETAILS`] words.
    #[doc(hidden)]
    #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
    fn throw<T: Thrower>(self, thrower: T) -> !;
    /// The exception with this code and these details; none if no variant has the code.
    ///
    /// # Safety
    /// Where a variant has the code, its details were stored by [`UserException::throw`].
    unsafe fn decode(code: u32, details: &[u32]) -> Option<Self>;
}

/// What ends a launch index. Each code is a constant of its own call, since OptiX takes no other.
#[doc(hidden)]
pub trait Thrower {
    /// Throws `CODE`.
    #[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
    fn throw<const CODE: u32>(self, details: &[u32; MAX_DETAILS]) -> !;
}

/// What programs of pipeline `P` throw: [`Throws`], read from the exception's side, which names it in messages.
///
/// # Safety
/// That of [`Throws`].
#[doc(hidden)]
pub unsafe trait ThrownBy<P>: UserException {}
// SAFETY: the pipeline's.
unsafe impl<P: Throws<E>, E: UserException> ThrownBy<P> for E {}

/// For pipelines whose programs throw nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoException {}

// SAFETY: there are no codes and no details.
unsafe impl UserException for NoException {
    const NAME: &'static str = "NoException";
    const DETAILS: usize = 0;
    const VARIANTS: &'static [(u32, &'static str)] = &[];
    fn throw<T: Thrower>(self, _: T) -> ! {
        match self {}
    }
    unsafe fn decode(_: u32, _: &[u32]) -> Option<Self> {
        None
    }
}

/// What an exception program is told of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Raised<E> {
    /// A program threw it.
    User(E),
    /// The continuation stack is too small: `OPTIX_EXCEPTION_CODE_STACK_OVERFLOW`.
    StackOverflow,
    /// Trace calls nest deeper than the pipeline says: `OPTIX_EXCEPTION_CODE_TRACE_DEPTH_EXCEEDED`.
    TraceDepthExceeded,
    /// Another code, such as those of the validation mode.
    Other(i32),
}

/// `OPTIX_EXCEPTION_CODE_STACK_OVERFLOW`.
pub(crate) const STACK_OVERFLOW: i32 = -1;
/// `OPTIX_EXCEPTION_CODE_TRACE_DEPTH_EXCEEDED`; the executor raises it too.
#[doc(hidden)]
pub const TRACE_DEPTH_EXCEEDED: i32 = -2;

impl<E: UserException> Raised<E> {
    /// The exception with this code and these details.
    ///
    /// # Safety
    /// A code from 0 on was thrown with these details as an `E`, or no variant of `E` has it.
    #[inline(always)]
    pub(crate) unsafe fn decode(code: i32, details: &[u32]) -> Self {
        match code {
            STACK_OVERFLOW => Self::StackOverflow,
            TRACE_DEPTH_EXCEEDED => Self::TraceDepthExceeded,
            // SAFETY: the caller's.
            _ => match u32::try_from(code).ok().and_then(|code| unsafe { E::decode(code, details) }) {
                Some(exception) => Self::User(exception),
                None => Self::Other(code),
            },
        }
    }
}
