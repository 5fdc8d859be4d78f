//! Parts of LLVM IR that are not known.

/// Something in LLVM IR that is not known, without its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unknown {
    /// What it is.
    pub reason: String,
    /// What to do, if there is a better way than to leave it out.
    pub hint: Option<&'static str>,
}

impl Unknown {
    pub fn new(reason: impl Into<String>) -> Self {
        Self { reason: reason.into(), hint: None }
    }

    pub fn hint(mut self, hint: &'static str) -> Self {
        self.hint = Some(hint);
        self
    }
}

/// Why a module was not read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refused {
    /// What is not known in it.
    pub unknown: Unknown,
    /// The line of the text, from 0.
    pub line: usize,
    /// The symbol of the function; empty outside of functions.
    pub function: String,
}
