//! Reads PTX: the functions and variables of a module, the statements of each function, the functions that it calls,
//! and the constants that it passes to them.
//!
//! The run time uses it to find which programs a pipeline reaches and which rays they trace; the toolchain, to check
//! that programs keep their contracts, and to measure what they cost. The text comes from compilers and, as inline
//! assembly, from people, so this follows the grammar of PTX and not the layout of one compiler. Any text can be read:
//! one that is not PTX gives a module with little in it.
//!
//! ```
//! let text = optix_ptx::plain(".version 7.8\n.target sm_75\n.visible .entry __raygen__a()\n{\n\
//!     \tmov.b32 %r1, 2; // the ray type\n\tcall (%r2), _optix_trace_typed_32, (%r1, %rd1);\n\tret;\n}\n");
//! let module = optix_ptx::Module::read(&text);
//! let program = module.get("__raygen__a").expect("it is there");
//! assert_eq!(program.calls()[0].function, "_optix_trace_typed_32");
//! assert_eq!(program.calls()[0].values, [Some(2), None]);
//! ```

mod calls;
mod constants;
mod flow;
mod local;
mod module;
mod prototype;
mod statement;

pub use calls::{Call, Parts};
pub use local::local_atomics;
pub use module::{Function, Module, Variable, is_callable};
pub use prototype::Prototype;
pub use statement::{Instruction, Statement, operands};

/// The text with a blank for each byte of a comment and of a `.file` line, whose path may contain anything. So whatever
/// is found in it is at the same place in the original.
///
/// ```
/// assert_eq!(optix_ptx::plain("ret; // é\n/* a\nb */ exit;"), "ret;      \n    \n     exit;");
/// ```
pub fn plain(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut in_comment = false;
    for line in text.split_inclusive('\n') {
        if !in_comment && line.split_whitespace().next() == Some(".file") {
            blank(line, &mut plain);
            continue;
        }
        let mut rest = line;
        while !rest.is_empty() {
            let (code, comment) = match in_comment {
                true => ("", rest),
                false => rest.split_at(comment_in(rest).unwrap_or(rest.len())),
            };
            plain.push_str(code);
            // The `*` that opens a comment is not the one that closes it.
            let opening = if !in_comment && comment.starts_with("/*") { 2 } else { 0 };
            let end = match opening > 0 || in_comment {
                true => comment[opening..].find("*/").map(|at| opening + at + 2),
                false => Some(comment.len()),
            };
            in_comment = end.is_none();
            let (comment, behind) = comment.split_at(end.unwrap_or(comment.len()));
            blank(comment, &mut plain);
            rest = behind;
        }
    }
    plain
}

/// The position at which a comment begins.
fn comment_in(text: &str) -> Option<usize> {
    text.match_indices('/').map(|(at, _)| at).find(|at| text[at + 1..].starts_with(['/', '*']))
}

/// Pushes as many blanks as the text has bytes; lines stay lines.
fn blank(text: &str, to: &mut String) {
    to.extend(text.bytes().map(|byte| if byte == b'\n' { '\n' } else { ' ' }));
}
