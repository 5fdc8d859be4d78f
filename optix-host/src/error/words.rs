//! How errors are printed: what is wrong and where, and on a line of its own what to do about it.

use std::borrow::Cow;
use std::fmt;

/// What is wrong, with the place, and what to do about it.
pub(super) type Words = (String, Cow<'static, str>);

/// A number of things, such as `1 level` and `2 levels`.
pub(super) fn number(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// Prints both.
pub(super) fn print(f: &mut fmt::Formatter<'_>, (problem, remedy): Words) -> fmt::Result {
    write!(f, "{problem}\n  what to do: {remedy}")
}

/// Makes errors of types that have a method `words(&self) -> Words`.
macro_rules! errors {
    ($($error:ty),+) => {$(
        impl $error {
            /// What is wrong, and where.
            pub fn problem(&self) -> String {
                self.words().0
            }

            /// What to do about it.
            pub fn remedy(&self) -> std::borrow::Cow<'static, str> {
                self.words().1
            }
        }

        impl std::fmt::Display for $error {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                $crate::error::words::print(f, self.words())
            }
        }

        /// As [`Display`](std::fmt::Display): what `main` prints of an error that it returns, and `unwrap` of one that it meets.
        impl std::fmt::Debug for $error {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                std::fmt::Display::fmt(self, f)
            }
        }

        impl std::error::Error for $error {}
    )+};
}

pub(super) use errors;
