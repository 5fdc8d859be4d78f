//! Memory that programs on several threads and the application read and write at the same time: every access is atomic, so that
//! racing ones are no worse than on a GPU. All accesses to an allocation have one width, since Rust does not define atomics of
//! two widths on one place.

use core::sync::atomic::{AtomicU8, AtomicU16, AtomicU32, Ordering::Relaxed};

/// Bytes of an access to elements of type `T`: 4, or their alignment if that is less.
pub const fn width<T>() -> usize {
    if align_of::<T>() < 4 { align_of::<T>() } else { 4 }
}

/// The body of a copy, for each width.
macro_rules! by_width {
    ($width:expr, $len:expr, |$atomic:ident, $word:ident, $i:ident| $copy:expr) => {
        match $width {
            1 => by_width!(@ AtomicU8, u8, $len, |$atomic, $word, $i| $copy),
            2 => by_width!(@ AtomicU16, u16, $len, |$atomic, $word, $i| $copy),
            _ => by_width!(@ AtomicU32, u32, $len, |$atomic, $word, $i| $copy),
        }
    };
    (@ $of:ident, $integer:ident, $len:expr, |$atomic:ident, $word:ident, $i:ident| $copy:expr) => {{
        use $of as $atomic;
        type $word = $integer;
        for $i in 0..$len / size_of::<$word>() {
            $copy
        }
    }};
}

/// Copies out of shared memory.
///
/// # Safety
/// `from` is valid for reads of `len` bytes and aligned to `width`, of which `len` is a multiple; others access it by atomics of
/// that width, or not at all. `to` is valid for writes of `len` bytes.
#[inline(always)]
pub unsafe fn read(from: *const u8, to: *mut u8, len: usize, width: usize) {
    by_width!(width, len, |Atomic, Word, i| {
        // SAFETY: the caller's; `i` counts words of the width below `len`.
        unsafe {
            let word = Atomic::from_ptr(from.cast::<Word>().cast_mut().add(i)).load(Relaxed);
            to.cast::<Word>().add(i).write_unaligned(word);
        }
    });
}

/// Copies into shared memory.
///
/// # Safety
/// As for [`read`], with `to` in the place of `from`.
#[inline(always)]
pub unsafe fn write(to: *mut u8, from: *const u8, len: usize, width: usize) {
    by_width!(width, len, |Atomic, Word, i| {
        // SAFETY: the caller's; `i` counts words of the width below `len`.
        unsafe {
            let word = from.cast::<Word>().add(i).read_unaligned();
            Atomic::from_ptr(to.cast::<Word>().add(i)).store(word, Relaxed);
        }
    });
}
