//! How a launch index ends before its programs have returned: by unwinding out of all of them, as there is no other way out of
//! a function that Rust would call sound.
//!
//! Programs are ordinary functions here, so they may catch what unwinds (`std::panic::catch_unwind`), and have destructors,
//! which run meanwhile. Neither takes an end back: what ended the index is kept beside the unwinding, the first of several
//! counts, and every later trace call, call, report, throw and use of a view, and the return of the program, ends the index again. A
//! destructor that runs while its program unwinds can't be ended again, since Rust ends the process where a destructor panics
//! then; so its trace calls and calls run no program and give back zeros, as [`goes_on`] says.

use super::reach::{self, Reach};
use super::{ExceptionState, Rule};
use core::any::Any;
use core::cell::{Cell, RefCell};
use core::ptr::NonNull;
use std::boxed::Box;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::string::{String, ToString};
use std::thread::panicking;
use std::vec::Vec;

/// Why a launch index ended.
#[derive(Clone, Debug)]
pub enum End {
    /// By an exception, which the exception program is told of.
    Thrown(ExceptionState),
    /// By a mistake of the program: the launch fails.
    Failed {
        /// The rule that it broke.
        rule: Rule,
        /// How it broke it, in words.
        what: String,
    },
}

/// What unwinds. It says nothing, so that it may be dropped or kept by whoever catches it.
struct Unwinding;

/// What ends an index whose program panics, where a destructor meanwhile asks for what is not done any more.
const IN_DESTRUCTOR: &str = "a destructor traces or calls while its program panics";

/// The programs of a launch index.
#[derive(Clone, Copy)]
struct Within {
    /// Whether the thread was unwinding when they began, as where a destructor launches.
    unwinding: bool,
    ended: bool,
    /// The memory that they had until they ended.
    reach: Option<NonNull<Reach>>,
}

std::thread_local! {
    /// The programs that [`catch`] called on this thread.
    static WITHIN: Cell<Option<Within>> = const { Cell::new(None) };
    /// What ended their launch index, above that of those around them.
    static ENDS: RefCell<Vec<End>> = const { RefCell::new(Vec::new()) };
}

/// Ends the launch index whose program runs on this thread and broke this rule: the launch fails with these words. No panic hook
/// runs.
///
/// # Panics
/// With the words where no program runs.
#[cold]
pub fn fail(rule: Rule, what: String) -> ! {
    end(End::Failed { rule, what })
}

/// Ends the launch index whose program runs on this thread by an exception. No panic hook runs.
///
/// # Safety
/// The code is negative, or the pipeline's exception type stored the details of a variant with this code
/// ([`UserException::throw`](crate::exception::UserException::throw)): the exception program takes views out of them.
#[cold]
pub unsafe fn throw(exception: ExceptionState) -> ! {
    end(End::Thrown(exception))
}

fn end(how: End) -> ! {
    match (WITHIN.get(), how) {
        (Some(Within { ended: true, .. }), _) => {}
        (Some(within), how) => {
            ENDS.with_borrow_mut(|ends| ends.push(how));
            WITHIN.set(Some(Within { ended: true, reach: reach::close(), ..within }));
        }
        (None, End::Failed { what, .. }) => panic!("{what}"),
        (None, End::Thrown(exception)) => panic!("exception {} is thrown outside of a program", exception.code),
    }
    resume_unwind(Box::new(Unwinding))
}

/// Whether a device function does what it is asked to. Where the launch index has ended and a program caught that, the index
/// ends again; where this is a destructor that runs while its program is unwound, the answer is no, and there is nothing to do;
/// if it is unwound by a panic of its own, which it may catch, the index has ended by that.
pub fn goes_on() -> bool {
    let Some(within) = WITHIN.get() else { return true };
    let unwound = panicking() != within.unwinding;
    match (within.ended, unwound) {
        (true, false) => resume_unwind(Box::new(Unwinding)),
        (false, true) => {
            ENDS.with_borrow_mut(|ends| ends.push(panicked(IN_DESTRUCTOR.to_string())));
            WITHIN.set(Some(Within { ended: true, reach: reach::close(), ..within }));
        }
        (true, true) | (false, false) => {}
    }
    !within.ended && !unwound
}

/// The memory of an index that has ended, where this is a destructor that runs while its program is unwound. Elsewhere in such
/// an index, which a program caught, the index ends again.
pub(super) fn closed() -> Option<NonNull<Reach>> {
    goes_on();
    WITHIN.get()?.reach
}

/// Runs programs of one launch index, and says what ended it, if it was not their return. A panic of their own ends it too.
///
/// # Safety
/// The caller is an executor, and not a program: it calls no program of this index any more if there was an end, and ends the
/// index. (A program that could call this would run on after calls whose results nobody made.)
pub unsafe fn catch<T>(programs: impl FnOnce() -> T) -> Result<T, End> {
    // Programs of another index may be on this thread already: one launches, or waits in a pool, which runs others meanwhile.
    let around = WITHIN.replace(Some(Within { unwinding: panicking(), ended: false, reach: None }));
    let result = catch_unwind(AssertUnwindSafe(programs));
    let end = WITHIN.replace(around).filter(|within| within.ended).and_then(|within| {
        reach::reopen(within.reach);
        ENDS.with_borrow_mut(Vec::pop)
    });
    match (result, end) {
        (Ok(result), None) => Ok(result),
        (Err(panic), None) => Err(panicked(words(panic))),
        // The panic itself says more, if the program did not catch it.
        (Err(panic), Some(End::Failed { what, .. })) if what == IN_DESTRUCTOR && !panic.is::<Unwinding>() => {
            Err(panicked(words(panic)))
        }
        (Err(panic), Some(end)) => {
            core::mem::forget(panic);
            Err(end)
        }
        (Ok(_), Some(end)) => Err(end),
    }
}

/// By a panic that says this.
fn panicked(what: String) -> End {
    End::Failed { rule: Rule::Panic, what }
}

/// What a panic says.
fn words(panic: Box<dyn Any + Send>) -> String {
    match panic.downcast::<String>() {
        Ok(words) => *words,
        Err(panic) => {
            let words = panic.downcast_ref::<&str>().copied().unwrap_or("it panicked").to_string();
            // Not dropped: it may be anything, and its destructor may panic.
            core::mem::forget(panic);
            words
        }
    }
}
