//! Device functions on the device: OptiX intrinsics, called the way OptiX's PTX reader wants them.
//!
//! OptiX checks the register type of every argument and result, and LLVM keeps `f32` in untyped `.b32` registers; so
//! each asm block declares `.f32` registers of its own and moves the bits across. Names, order, register types and
//! volatility follow the public device headers of OptiX 9.0 as facts.

pub mod approximate;
#[macro_use]
mod call;
mod callable;
mod exception;
mod hit;
mod launch;
mod params;
mod payload;
mod ray;
mod report;
mod trace;
mod transform;
mod vertices;

pub use hit::{is_back_face, primitive_type_of};
pub use params::{ParamsBase, load_param};
pub use payload::{UNWRITTEN, unwritten};

use core::arch::asm;

/// Ends the program.
#[inline(always)]
pub fn trap() -> ! {
    // SAFETY: `trap` ends the launch.
    unsafe { asm!("trap; exit;", options(noreturn, nomem)) }
}

/// Ends the program unless `index < len`.
///
/// A predicated instruction: a branch would hold back the loads behind it until the ones that the index came from are done.
///
/// The message is the host's: the device has no use for it.
#[inline(always)]
pub fn check(index: u64, len: u64, _: core::fmt::Arguments<'_>) {
    // SAFETY: `trap` ends the launch.
    unsafe {
        asm!(
            "{{ .reg .pred p; setp.ge.u64 p, {index}, {len}; @p trap; }}",
            index = in(reg64) index,
            len = in(reg64) len,
            options(nomem, nostack, preserves_flags)
        )
    }
}

/// The running program: no state, the intrinsics know.
#[derive(Clone, Copy)]
pub struct Cx(());

impl Cx {
    /// The context of an entry point.
    ///
    /// # Safety
    /// Called in an OptiX program of the kind whose context is made from it.
    #[inline(always)]
    pub unsafe fn new() -> Self {
        Self(())
    }
}
