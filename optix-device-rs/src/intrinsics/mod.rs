//! Device functions: OptiX intrinsics on the device, and on the host what the executor knows of the program call. A file for
//! each topic; those that ask about a kind of primitive are in that kind's file, in [`primitive`](crate::primitive).
//!
//! What programs call is in tables (`table.rs`): a row has the documentation of a function, which kinds of program may call
//! it, and what it does on either machine. What the rest of this crate calls are methods of [`Invocation`].

#[macro_use]
mod table;
#[cfg(target_arch = "nvptx64")]
#[macro_use]
mod ptx;

#[cfg(target_arch = "nvptx64")]
pub mod approximate;
mod callable;
mod exception;
mod hit;
mod launch;
mod memory;
mod payload;
mod ray;
mod report;
mod trace;
mod transform;

pub use callable::{CallsContinuation, CallsDirect, Context};
pub use hit::{is_back_face, primitive_type_of};
pub use launch::{ParamsBase, load_param};
#[cfg(target_arch = "nvptx64")]
pub use memory::trap;
pub use memory::{address_of, check, checked_address, join_words};
pub use payload::{UNWRITTEN, unwritten};
pub use trace::TraceCall;

#[cfg(not(target_arch = "nvptx64"))]
use crate::host::{Frame, Rule, end};

/// The running program, as the device functions see it: nothing on the device, where the intrinsics know which it is; on the
/// host the frame that the executor made for the program call.
#[derive(Clone, Copy)]
pub struct Invocation(
    #[cfg(target_arch = "nvptx64")] (),
    #[cfg(not(target_arch = "nvptx64"))] core::ptr::NonNull<Frame<'static>>,
);

#[cfg(target_arch = "nvptx64")]
impl Invocation {
    /// That of an entry point.
    ///
    /// # Safety
    /// Called in an OptiX program of the kind whose context is made from it.
    #[inline(always)]
    pub unsafe fn new() -> Self {
        Self(())
    }
}

#[cfg(not(target_arch = "nvptx64"))]
impl Invocation {
    /// That of a program call.
    ///
    /// # Safety
    /// `frame` outlives every use of the invocation (the program call), its parameters are a valid `P::Params` of the
    /// pipeline whose program is called, and its record is of the program's record type.
    pub unsafe fn new(frame: &Frame<'_>) -> Self {
        Self(core::ptr::NonNull::from(frame).cast())
    }

    /// What the executor made for the call. Device functions read it while they run, and keep no reference to it.
    #[inline(always)]
    pub(crate) fn frame(&self) -> &Frame<'static> {
        #[cold]
        #[inline(never)]
        fn waits() -> ! {
            let what = "a context is used while another program runs than the one that it was given to";
            end::fail(Rule::Context, what.into())
        }
        // SAFETY: the promise of `new`.
        let frame = unsafe { self.0.as_ref() };
        if frame.turn.waits() {
            waits();
        }
        frame
    }
}

mod private {
    /// Only this crate asks a context for its invocation, and makes contexts, since nobody else can name this: programs would get
    /// round what a context allows.
    pub struct Private(pub(crate) ());
}
pub(crate) use private::Private;

/// A row of the table, for the tests that compare it with the guide's.
#[cfg(not(target_arch = "nvptx64"))]
#[derive(Clone, Copy, Debug)]
pub struct DeviceFunction {
    /// The name in OptiX.
    pub optix: &'static str,
    /// The contexts that have it.
    pub contexts: &'static [&'static str],
}

/// The tables of all files.
#[cfg(not(target_arch = "nvptx64"))]
pub fn table() -> impl Iterator<Item = &'static DeviceFunction> {
    let here: [&[DeviceFunction]; 5] =
        [launch::FUNCTIONS, ray::FUNCTIONS, hit::FUNCTIONS, transform::FUNCTIONS, exception::FUNCTIONS];
    here.into_iter().chain(crate::primitive::TABLES.iter().copied()).flatten()
}
