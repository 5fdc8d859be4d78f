//! Payload words (guide 13.3, 14).

use super::Invocation;
#[cfg(not(target_arch = "nvptx64"))]
use crate::limits::MAX_PAYLOAD_WORDS;
use crate::words::WordBuffer;
#[cfg(target_arch = "nvptx64")]
use core::arch::asm;
#[cfg(not(target_arch = "nvptx64"))]
use core::cell::Cell;
use core::mem::MaybeUninit;

/// What a trace call passes for a payload word that its caller does not write.
#[cfg(target_arch = "nvptx64")]
pub const UNWRITTEN: u32 = 0;

/// What a payload word that nobody has written yet holds: a NaN, and as an index out of range of everything, so that a program
/// that were to read it would show.
#[cfg(not(target_arch = "nvptx64"))]
pub const UNWRITTEN: u32 = 0xffcd_cdcd;

/// Memory that nobody has written yet: on the host words of [`UNWRITTEN`].
///
/// # Safety
/// A `T` is an array of words, which may be any.
#[inline(always)]
pub unsafe fn unwritten<T>(memory: &mut MaybeUninit<T>) -> &mut T {
    body! {
        ptx {
            // SAFETY: no instruction; but the compiler must take it that the block writes what it has the address of, and the caller
            // says that any bytes are a `T`.
            unsafe {
                asm!("// {0}", in(reg64) memory.as_mut_ptr(), options(nostack, preserves_flags));
                memory.assume_init_mut()
            }
        }
        host {
            let words = memory.as_mut_ptr().cast::<u32>();
            // SAFETY: the words are `memory`'s, and the caller says that any are a `T`.
            unsafe {
                for i in 0..size_of::<T>() / 4 {
                    words.add(i).write(UNWRITTEN);
                }
                memory.assume_init_mut()
            }
        }
    }
}

impl Invocation {
    /// The program takes these fields of its payload; for the executor's checks.
    #[inline(always)]
    pub fn takes(&self, fields: &'static [usize]) {
        body! {
            ptx { let _ = fields; }
            host {
                if let Some(watch) = self.frame().watch {
                    watch.takes(fields);
                }
            }
        }
    }

    /// The program gives these fields of its payload; for the executor's checks.
    #[inline(always)]
    pub fn gives(&self, fields: &'static [usize]) {
        body! {
            ptx { let _ = fields; }
            host {
                if let Some(watch) = self.frame().watch {
                    watch.gives(fields);
                }
            }
        }
    }

    /// Says which payload types the program runs for: the first call of a program that has a payload.
    #[inline(always)]
    pub fn set_payload_type(&self, mask: u32) {
        body! {
            ptx {
                // SAFETY: first call of a program that has a payload.
                unsafe {
                    asm!(
                        "call _optix_set_payload_types, ({m});",
                        m = in(reg32) mask,
                        options(nostack, preserves_flags)
                    )
                };
            }
            host { let _ = mask; }
        }
    }

    /// The payload words in `mask`. On the device the others are zero; on the host they are there, too: the caller inlines this
    /// and uses the words of `mask` only, so no more are copied.
    #[inline(always)]
    pub fn payload(&self, mask: u32) -> WordBuffer {
        body! {
            ptx {
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
            host {
                let _ = mask;
                self.frame().payload.get()
            }
        }
    }

    /// Sets the payload words in `mask`.
    #[inline(always)]
    pub fn set_payload(&self, mask: u32, words: &WordBuffer) {
        body! {
            ptx {
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
            host {
                // Word by word: the mask is a constant, and most payloads are much smaller than the buffer.
                let payload = each_word(self.frame().payload);
                for (i, (to, from)) in payload.iter().zip(&words.0).enumerate() {
                    if mask & 1 << i != 0 {
                        to.set(*from);
                    }
                }
            }
        }
    }
}

/// The payload's words, each a cell of its own.
#[cfg(not(target_arch = "nvptx64"))]
#[inline(always)]
fn each_word(payload: &Cell<WordBuffer>) -> &[Cell<u32>; MAX_PAYLOAD_WORDS] {
    // SAFETY: `WordBuffer` is transparent over `[u32; MAX_PAYLOAD_WORDS]` and `Cell<T>` over `T`, and a cell of an array may
    // be taken for an array of cells, as `Cell::as_slice_of_cells` does.
    unsafe { &*core::ptr::from_ref(payload).cast() }
}
