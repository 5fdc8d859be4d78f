//! Reads LLVM IR as text, as `rustc` writes it for the device after link-time optimisation. No LLVM is needed.
//!
//! | step | module |
//! | --- | --- |
//! | text to words | `lexer` |
//! | words to a model | `parse`, [`model`], [`opcode`] |
//! | from an instruction to the source that it comes from | `origin` |
//!
//! [`module`] refuses what it does not know; it is for translating the module. [`known`] leaves out what it does not
//! know; it is for searching the module.

mod lexer;
pub mod model;
pub mod opcode;
mod origin;
mod parse;
mod unknown;

pub use origin::{Frame, Origins};
pub use parse::{known, module};
pub use unknown::{Refused, Unknown};
