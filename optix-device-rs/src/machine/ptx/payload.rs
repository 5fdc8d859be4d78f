//! Payload words (guide 13.3, 14).

use super::Cx;
use crate::words::WordBuffer;
use core::arch::asm;
use core::mem::MaybeUninit;

/// What a trace call passes for a payload word that its caller does not write.
pub const UNWRITTEN: u32 = 0;

/// Memory that nobody has written yet.
///
/// # Safety
/// A `T` is an array of words, which may be any.
#[inline(always)]
pub unsafe fn unwritten<T>(memory: &mut MaybeUninit<T>) -> &mut T {
    // SAFETY: no instruction; but the compiler must take it that the block writes what it has the address of, and the caller
    // says that any bytes are a `T`.
    unsafe {
        asm!("// {0}", in(reg64) memory.as_mut_ptr(), options(nostack, preserves_flags));
        memory.assume_init_mut()
    }
}

impl Cx {
    /// For the executor's checks.
    #[inline(always)]
    pub fn takes(&self, _: &'static [usize]) {}
    /// For the executor's checks.
    #[inline(always)]
    pub fn gives(&self, _: &'static [usize]) {}

    #[inline(always)]
    pub fn set_payload_type(&self, mask: u32) {
        // SAFETY: first call of a program that has a payload.
        unsafe {
            asm!(
                "call _optix_set_payload_types, ({m});",
                m = in(reg32) mask,
                options(nostack, preserves_flags)
            )
        };
    }

    /// The payload words in `mask`; the others are zero.
    #[inline(always)]
    pub fn payload(&self, mask: u32) -> WordBuffer {
        let mut words = WordBuffer::ZERO;
        macro_rules! get {
            ($($i:literal)*) => {$(
                if mask & 1 << $i != 0 {
                    // SAFETY: the program's payload type has word `i` with the read semantic (`mask`).
                    unsafe {
                        asm!(
                            "call ({w}), _optix_get_payload, ({i});",
                            w = out(reg32) words.0[$i],
                            i = in(reg32) $i,
                            // Goes if nobody needs the word; stays where it is among calls that set words, which
                            // count as writes to memory.
                            options(pure, readonly, nostack, preserves_flags)
                        )
                    };
                }
            )*};
        }
        get!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31);
        words
    }

    /// Sets the payload words in `mask`.
    #[inline(always)]
    pub fn set_payload(&self, mask: u32, words: &WordBuffer) {
        macro_rules! set {
            ($($i:literal)*) => {$(
                if mask & 1 << $i != 0 {
                    // SAFETY: the program's payload type has word `i` with the write semantic (`mask`).
                    unsafe {
                        asm!(
                            "call _optix_set_payload, ({i}, {w});",
                            w = in(reg32) words.0[$i],
                            i = in(reg32) $i,
                            options(nostack, preserves_flags)
                        )
                    };
                }
            )*};
        }
        set!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31);
    }
}
