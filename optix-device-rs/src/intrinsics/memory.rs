//! Memory that views show, and arithmetic that is an instruction on the device.

#[cfg(not(target_arch = "nvptx64"))]
use crate::host::{Rule, end, name_of};
#[cfg(target_arch = "nvptx64")]
use core::arch::asm;
#[cfg(not(target_arch = "nvptx64"))]
use core::panic::Location;
#[cfg(not(target_arch = "nvptx64"))]
use std::format;

/// Ends the program.
#[cfg(target_arch = "nvptx64")]
#[inline(always)]
pub fn trap() -> ! {
    // SAFETY: `trap` ends the launch.
    unsafe { asm!("trap; exit;", options(noreturn, nomem)) }
}

/// Ends the program unless `index < len`. On the host the message says why, and which place asked; the device has no use for it.
#[inline(always)]
#[cfg_attr(not(target_arch = "nvptx64"), track_caller)]
pub fn check(
    index: u32,
    len: u32,
    #[cfg_attr(target_arch = "nvptx64", expect(unused_variables, reason = "the message is the host's"))]
    message: core::fmt::Arguments<'_>,
) {
    #[cfg(not(target_arch = "nvptx64"))]
    #[cold]
    #[inline(never)]
    fn out_of_range(message: core::fmt::Arguments<'_>, at: &Location<'_>) -> ! {
        end::fail(Rule::Index, format!("{message}, at {at}"))
    }
    if index >= len {
        #[cfg(target_arch = "nvptx64")]
        trap();
        #[cfg(not(target_arch = "nvptx64"))]
        out_of_range(message, Location::caller());
    }
}

/// Where the memory of a view begins. On the host the program ends if it is no view of the running launch.
#[inline(always)]
pub fn address_of(view: u64) -> *mut u8 {
    body! {
        ptx { view as *mut u8 }
        host { crate::host::memory(view).as_ptr() }
    }
}

/// The place `offset` bytes into the memory of a view, if each index is below its length. Otherwise the host ends the program with
/// this message; the device gives a place that no memory has (addresses have 49 bits), so that an access ends the launch.
///
/// On the device that is two instructions an index, and no branch: a trap takes six, and what holds launches up is the fetching
/// of instructions.
#[cfg(target_arch = "nvptx64")]
#[inline(always)]
pub fn checked_address<const N: usize>(
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

/// On the host; see above.
#[cfg(not(target_arch = "nvptx64"))]
#[inline(always)]
#[track_caller]
pub fn checked_address<const N: usize>(
    in_range: [(u32, u32); N],
    view: u64,
    offset: u64,
    message: core::fmt::Arguments<'_>,
) -> *mut u8 {
    #[cold]
    #[inline(never)]
    fn out_of_range(view: u64, message: core::fmt::Arguments<'_>, at: &Location<'_>) -> ! {
        end::fail(Rule::Index, format!("{message}, at {at}{}", name_of(view)))
    }
    if in_range.iter().any(|(index, len)| index >= len) {
        out_of_range(view, message, Location::caller());
    }
    address_of(view).wrapping_add(offset as usize)
}

/// The 64-bit value of two words.
///
/// On the device by an instruction that OptiX's compiler does not see through. It counts what is made of payload words by plain
/// arithmetic as free to be made again, and so computed a random sequence a second time behind each trace call (2 % of a path
/// tracer's launch time).
#[inline(always)]
pub fn join_words(low: u32, high: u32) -> u64 {
    body! {
        ptx {
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
        host { u64::from(low) | u64::from(high) << 32 }
    }
}
