//! PTX with the source lines that it comes from.

use std::collections::HashMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use optix_ptx::{Module, Statement};

use crate::ptx::demangled;

/// The instructions of each program that `wanted` accepts, each run of them below the source line that it was made
/// from. `None` if the PTX has no line information.
///
/// For a file that can't be read, only path and line are shown. Relative paths, such as those of `core`, are not
/// searched for.
pub fn with_source(ptx: &str, wanted: impl Fn(&str) -> bool) -> Option<String> {
    let files = files(ptx);
    if files.is_empty() {
        return None;
    }
    let mut sources = Sources { files, texts: HashMap::new() };
    let plain = optix_ptx::plain(ptx);
    let mut text = String::new();
    for function in Module::read(&plain).defined() {
        let name = demangled(function.name);
        if !wanted(&name) {
            continue;
        }
        let _ = writeln!(text, "{name}");
        let mut shown = None;
        let mut next = None;
        for statement in function.statements() {
            match statement {
                Statement::Directive(directive) => next = location(directive).or(next),
                // These labels belong to debug information, and nothing jumps to them.
                Statement::Label(label) if label.starts_with("$L__tmp") || label.starts_with("$L__func") => {}
                Statement::Label(label) => {
                    let _ = writeln!(text, "    {label}:");
                }
                Statement::Instruction(instruction) => {
                    if next != shown {
                        shown = next;
                        let line = next.map(|(file, line)| sources.line(file, line)).unwrap_or_default();
                        let _ = writeln!(text, "  {line}");
                    }
                    let guard = if instruction.guard.is_empty() { "" } else { "@" };
                    let space = if guard.is_empty() { "" } else { " " };
                    let operands = instruction.operands.split_whitespace().collect::<Vec<_>>().join(" ");
                    let _ = writeln!(text, "        {guard}{}{space}{} {operands}", instruction.guard, instruction.op);
                }
            }
        }
        text.push('\n');
    }
    Some(text)
}

/// The paths of the files, by the numbers that `.file 1 "path"` gives them.
fn files(ptx: &str) -> HashMap<usize, PathBuf> {
    let file = |line: &str| {
        let (number, path) = line.trim().strip_prefix(".file")?.trim().split_once(char::is_whitespace)?;
        Some((number.parse().ok()?, PathBuf::from(path.split('"').nth(1)?)))
    };
    ptx.lines().filter_map(file).collect()
}

/// File and line of `.loc 1 12 5`. Line 0 is code that belongs to no line.
fn location(directive: &str) -> Option<(usize, usize)> {
    let mut numbers = directive.strip_prefix(".loc")?.split([' ', '\t', ',']).filter(|word| !word.is_empty());
    let (file, line) = (numbers.next()?.parse().ok()?, numbers.next()?.parse().ok()?);
    (line > 0).then_some((file, line))
}

struct Sources {
    files: HashMap<usize, PathBuf>,
    texts: HashMap<usize, Vec<String>>,
}

impl Sources {
    /// `src/camera.rs:12: let x = 1;`
    fn line(&mut self, file: usize, line: usize) -> String {
        let Some(path) = self.files.get(&file) else { return String::new() };
        let texts = self.texts.entry(file).or_insert_with(|| {
            let text =
                if path.is_absolute() { std::fs::read_to_string(path).unwrap_or_default() } else { String::new() };
            text.lines().map(|line| line.trim().to_string()).collect()
        });
        let source = texts.get(line - 1).map(String::as_str).unwrap_or_default();
        format!("{}:{line}: {source}", short(path)).trim_end().trim_end_matches(':').to_string()
    }
}

/// The last parts of a path, beginning with the folder that holds `src`.
fn short(path: &Path) -> String {
    let parts: Vec<_> = path.iter().map(|part| part.to_string_lossy()).collect();
    let from =
        parts.iter().rposition(|part| part == "src").map_or(parts.len().saturating_sub(1), |at| at.saturating_sub(1));
    parts[from..].join("/")
}
