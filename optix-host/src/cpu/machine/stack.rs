//! How much of its stack a thread has left: programs that call each other on the CPU use the stack of the thread that runs
//! them, and one that ends in the middle would end the process.

use std::cell::Cell;

/// Left to the program that is called last, and to unwinding.
const RESERVE: usize = 256 << 10;

/// The lowest address that calls on this thread may reach.
#[derive(Clone, Copy)]
pub(super) struct StackEnd(usize);

impl StackEnd {
    /// Of the thread that asks.
    pub fn of_this_thread() -> Self {
        thread_local! {
            static END: Cell<Option<usize>> = const { Cell::new(None) };
        }
        Self(END.get().unwrap_or_else(|| {
            let (low, size) = bounds();
            let end = low + RESERVE.min(size / 4);
            END.set(Some(end));
            end
        }))
    }

    /// Whether the stack goes no deeper.
    #[inline]
    pub fn is_reached(self) -> bool {
        here() < self.0
    }
}

/// An address of the innermost frame.
#[inline]
fn here() -> usize {
    let byte = 0u8;
    (&raw const byte).addr()
}

/// The lowest address of this thread's stack, and its size in bytes.
#[cfg(all(target_os = "linux", not(miri)))]
fn bounds() -> (usize, usize) {
    let mut attributes = core::mem::MaybeUninit::<libc::pthread_attr_t>::uninit();
    let (mut low, mut size) = (core::ptr::null_mut(), 0);
    // SAFETY: the attributes are written by the first call, read by the second where that went well, and freed by the third.
    let known = unsafe {
        libc::pthread_getattr_np(libc::pthread_self(), attributes.as_mut_ptr()) == 0 && {
            let known = libc::pthread_attr_getstack(attributes.as_ptr(), &mut low, &mut size) == 0;
            libc::pthread_attr_destroy(attributes.as_mut_ptr());
            known
        }
    };
    if known { (low.addr(), size) } else { assumed() }
}

#[cfg(any(not(target_os = "linux"), miri))]
fn bounds() -> (usize, usize) {
    assumed()
}

/// Half of what Rust gives its threads, from here on.
fn assumed() -> (usize, usize) {
    let size = 1 << 20;
    (here().saturating_sub(size), size)
}
