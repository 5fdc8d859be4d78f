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

/// Ends the launch unless `index < len`.
///
/// The message is the host's: the device has no use for it.
#[inline(always)]
pub fn check(index: u32, len: u32, _: core::fmt::Arguments<'_>) {
    if index >= len {
        trap()
    }
}

/// Where the memory of a view begins.
#[inline(always)]
pub fn place(view: u64) -> *mut u8 {
    view as *mut u8
}

/// The place `offset` bytes into the memory of a view, if each index is below its length; otherwise one that no memory has
/// (addresses have 49 bits), so that an access ends the launch.
///
/// Two instructions an index, and no branch: a trap takes six, and what holds launches up is the fetching of instructions.
#[inline(always)]
pub fn place_if<const N: usize>(
    in_range: [(u32, u32); N],
    view: u64,
    offset: u64,
    _: core::fmt::Arguments<'_>,
) -> *mut u8 {
    let mut address = view.wrapping_add(offset);
    for (index, len) in in_range {
        // SAFETY: no effect but on the address.
        unsafe {
            asm!(
                "{{ .reg .pred p; .reg .b32 low, high; setp.lt.u32 p, {index}, {len}; mov.b64 {{low, high}}, {address}; ",
                "selp.b32 high, high, 0xffffffff, p; mov.b64 {address}, {{low, high}}; }}",
                index = in(reg32) index,
                len = in(reg32) len,
                address = inout(reg64) address,
                options(pure, nomem, nostack, preserves_flags)
            )
        }
    }
    address as *mut u8
}

/// The 64-bit value of two words.
///
/// By an instruction that OptiX's compiler does not see through. It counts what is made of payload words by plain arithmetic
/// as free to be made again, and so computed a random sequence a second time behind each trace call (2 % of a path tracer's
/// launch time).
#[inline(always)]
pub fn wide(low: u32, high: u32) -> u64 {
    let wide: u64;
    // SAFETY: arithmetic on registers.
    unsafe {
        asm!(
            "{{ .reg .b64 l, h; cvt.u64.u32 l, {low}; cvt.u64.u32 h, {high}; bfi.b64 {wide}, h, l, 32, 32; }}",
            low = in(reg32) low,
            high = in(reg32) high,
            wide = out(reg64) wide,
            options(pure, nomem, nostack, preserves_flags)
        )
    }
    wide
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
