//! How much of its stack a thread has left. On the CPU, programs that call each other use the stack of the thread that
//! runs them, and the process would end if that overflowed.

use std::cell::Cell;

/// The bytes that are left to the program that is called last, and to unwinding.
const RESERVE: usize = 256 << 10;
/// The least reserve. On small stacks a quarter of the stack is reserved, but no less than this, since a program that
/// calls another uses up to some kilobytes before the stack is checked again.
const LEAST_RESERVE: usize = 48 << 10;

/// The range of addresses in which calls on this thread may run.
#[derive(Clone, Copy)]
pub(super) struct Stack {
    end: usize,
    begin: usize,
}

/// Whether a stack has room for another call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Left {
    Enough,
    /// The stack is used up.
    Nothing,
    /// The program runs on another stack than its thread's, as with the crate `stacker`. Its end is not known.
    Elsewhere,
}

impl Stack {
    /// Of the thread that asks.
    pub fn of_this_thread() -> Self {
        thread_local! {
            static STACK: Cell<Option<Stack>> = const { Cell::new(None) };
        }
        STACK.get().unwrap_or_else(|| {
            let (low, size) = bounds();
            let stack = Self { end: low + RESERVE.min(LEAST_RESERVE.max(size / 4)), begin: low.saturating_add(size) };
            STACK.set(Some(stack));
            stack
        })
    }

    /// Whether there is room. An address further below the end than the reserve is on another stack, or in a frame that
    /// is as large as that.
    #[inline]
    pub fn left(self) -> Left {
        let here = here();
        if (self.end..=self.begin).contains(&here) {
            return Left::Enough;
        }
        let within = self.end.saturating_sub(RESERVE)..self.end;
        if within.contains(&here) { Left::Nothing } else { Left::Elsewhere }
    }
}

/// An address in the innermost frame.
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

/// Half of the stack that Rust gives its threads, from the current frame on. Where the stack begins is not known.
fn assumed() -> (usize, usize) {
    let low = here().saturating_sub(1 << 20);
    (low, usize::MAX - low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stack_that_is_not_the_threads_has_no_known_end() {
        assert_eq!(Stack::of_this_thread().left(), Left::Enough);
        let here = here();
        for (end, begin, left) in [
            (here - RESERVE, here + RESERVE, Left::Enough),
            (here + RESERVE / 2, here + 8 * RESERVE, Left::Nothing),
            (here + 2 * RESERVE, here + 8 * RESERVE, Left::Elsewhere),
            (here - 8 * RESERVE, here - RESERVE, Left::Elsewhere),
        ] {
            assert_eq!(Stack { end, begin }.left(), left, "{end:x} {begin:x}");
        }
    }
}
