//! What can't be translated, and why.

use std::fmt;

use optix_llvm_ir::Unknown;

/// A construct of LLVM IR that this translation does not know.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// The Rust function it is in, as a path; empty outside of functions.
    pub function: String,
    /// The line of IR.
    pub instruction: String,
    /// What is not known about it.
    pub reason: String,
    /// What to do.
    pub hint: &'static str,
}

/// A remedy that always works.
const OTHER_GENERATOR: &str = "compile this crate with rustc's own code generator (`--codegen rustc`)";

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("libNVVM can't be given ")?;
        match self.function.as_str() {
            "" => {}
            function => write!(f, "`{function}`: ")?,
        }
        write!(f, "{} in `{}`; {}", self.reason, self.instruction, self.hint)
    }
}

impl std::error::Error for Refusal {}

impl Refusal {
    /// The refusal of something in line `line` of `text`, in the function with that symbol.
    pub(super) fn of(unknown: Unknown, text: &str, line: usize, symbol: &str) -> Self {
        let instruction = text.lines().nth(line).unwrap_or_default().trim();
        let end = instruction.char_indices().nth(160).map_or(instruction.len(), |(at, _)| at);
        Self {
            function: format!("{:#}", rustc_demangle::demangle(symbol)),
            instruction: instruction[..end].to_string(),
            reason: unknown.reason,
            hint: unknown.hint.unwrap_or(OTHER_GENERATOR),
        }
    }
}
