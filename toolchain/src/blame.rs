//! Which crate, function and line asks for what the device does not have.
//!
//! After optimisation a missing function is called from an entry, where everything was inlined. But LLVM IR with line
//! information has for each instruction the chain of functions that it comes from, so the crate is compiled again that way.

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

use crate::metadata::Package;
use crate::wrapper::NO_HEAP;

/// Something that a shader crate uses and the device does not have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Culprit {
    /// What is missing.
    pub what: Missing,
    /// The function that uses it: the innermost one of a package.
    pub at: Place,
    /// Where the shader crate comes to that, if it is in another package.
    pub from: Option<Place>,
}

/// What is missing.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Missing {
    /// Memory that is allocated at run time.
    Heap,
    /// The function of this name.
    Function(String),
    /// Calls through pointers.
    Pointers,
    /// A function that calls itself, and device functions.
    Recursion,
    /// Conversions between floats and 128-bit integers.
    WideConversion,
}

/// A place in the source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The function's name.
    pub function: String,
    /// The name and version of its package.
    pub package: String,
    /// The file, relative to the package.
    pub file: PathBuf,
    /// The line, from 1.
    pub line: u32,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` of {} ({}:{})", self.function, self.package, self.file.display(), self.line)
    }
}

impl fmt::Display for Culprit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, at, from } = self;
        match what {
            Missing::Heap => write!(f, "the device has no heap, and {at} allocates")?,
            Missing::Function(name) => write!(f, "nothing on the device defines `{name}`, which {at} calls")?,
            Missing::Pointers => write!(f, "OptiX does not call functions through pointers, as {at} does")?,
            Missing::Recursion => {
                write!(f, "OptiX does not let a recursive function call device functions, as {at} does")?
            }
            Missing::WideConversion => {
                write!(f, "the device can't convert between floats and 128-bit integers, as {at} does")?
            }
        }
        if let Some(from) = from {
            write!(f, ", for {from}")?;
        }
        f.write_str(match what {
            Missing::Heap => {
                "; use arrays or collections of fixed size, or pass a view of a buffer that the host allocates"
            }
            Missing::Function(_) => {
                "; use another function, or `#[cfg(not(target_arch = \"nvptx64\"))]` where only the host calls it"
            }
            Missing::Pointers => {
                "; use generics, an enum or a callable in place of a `dyn` object or `fn` pointer, and format nothing"
            }
            Missing::Recursion => "; use a loop",
            Missing::WideConversion => "; convert by way of 64 bits",
        })
    }
}

/// The first of `missing` that a function in the IR of a device build uses, with the place. The places are of
/// `packages`; other code, such as the standard library's, is passed over. The shader crate is `own`.
pub(crate) fn culprit(ir: &str, missing: &[Missing], packages: &[Package], own: &Package) -> Option<Culprit> {
    let ir = Ir::new(ir);
    let find = |what: &Missing| (0..ir.lines.len()).find(|line| ir.uses(*line, what));
    let (what, line) = missing.iter().find_map(|what| Some((what, find(what)?)))?;
    let places: Vec<(&Package, Place)> = ir.frames(line).filter_map(|frame| frame.place(packages)).collect();
    let (package, at) = places.first()?.clone();
    let from = places.into_iter().find(|(package, _)| package.id == own.id).map(|(_, place)| place);
    Some(Culprit { what: what.clone(), at, from: from.filter(|_| package.id != own.id) })
}

impl Missing {
    /// What an unresolved symbol in PTX stands for.
    pub(crate) fn of_symbol(symbol: &str) -> Self {
        if symbol == NO_HEAP { Self::Heap } else { Self::Function(symbol.to_string()) }
    }
}

/// LLVM IR by lines, and its numbered metadata.
struct Ir<'a> {
    lines: Vec<&'a str>,
    metadata: BTreeMap<u32, &'a str>,
}

/// A function that an instruction comes from.
struct Frame<'a> {
    function: &'a str,
    file: PathBuf,
    line: u32,
}

impl<'a> Ir<'a> {
    fn new(text: &'a str) -> Self {
        let lines: Vec<&str> = text.lines().collect();
        let node = |line: &'a str| {
            let (number, node) = line.strip_prefix('!')?.split_once(" = ")?;
            Some((number.parse().ok()?, node))
        };
        Self { metadata: lines.iter().copied().filter_map(node).collect(), lines }
    }

    /// Whether the instruction in a line uses what is missing.
    fn uses(&self, line: usize, what: &Missing) -> bool {
        let text = self.lines[line];
        let has = |parts: &[&str]| parts.iter().any(|part| text.contains(part));
        let calls = |name: &str| has(&["call "]) && names(text, name);
        match what {
            Missing::Heap => calls(&format!("@{NO_HEAP}")),
            Missing::Function(name) => calls(&format!("@{name}")),
            Missing::Recursion => has(&["call "]) && self.within(line).is_some_and(calls),
            Missing::Pointers => {
                let callee = text.split_once("call ").and_then(|(_, call)| call.split_once('('));
                callee
                    .is_some_and(|(callee, _)| callee.rsplit(' ').next().is_some_and(|callee| callee.starts_with('%')))
            }
            Missing::WideConversion => {
                let from = has(&[" uitofp ", " sitofp "]) && has(&[" i128 "]);
                let to = has(&[" fptoui ", " fptosi "]) && has(&[" to i128"]);
                from || to || (has(&["call "]) && has(&["@llvm.fptoui.sat.i128", "@llvm.fptosi.sat.i128"]))
            }
        }
    }

    /// The symbol of the function or variable that a line belongs to.
    fn within(&self, line: usize) -> Option<&'a str> {
        let is_head = |line: &&&str| line.starts_with("define ") || line.starts_with('@');
        self.lines[..=line].iter().rfind(is_head).and_then(|head| symbol(head))
    }

    /// The functions that the instruction in a line comes from, the nearest first: those that were inlined, and then those
    /// of what uses the function that it is in, directly or by a table.
    fn frames(&self, line: usize) -> impl Iterator<Item = Frame<'a>> {
        let mut lines = vec![line];
        let mut at = 0;
        while let Some(&line) = lines.get(at) {
            if let Some(symbol) = self.within(line) {
                let is_use =
                    |line: &str| !line.starts_with("define ") && !line.starts_with(symbol) && names(line, symbol);
                let uses = self.lines.iter().enumerate().filter(|(_, line)| is_use(line)).map(|(line, _)| line);
                let new: Vec<usize> = uses.filter(|line| !lines.contains(line)).collect();
                lines.extend(new);
            }
            at += 1;
        }
        lines.into_iter().flat_map(|line| self.inlined(self.lines[line]))
    }

    /// The functions that were inlined to make an instruction, up to the one that it is in.
    fn inlined(&self, instruction: &'a str) -> Vec<Frame<'a>> {
        let mut frames = Vec::new();
        let mut location = reference(instruction, "!dbg !");
        while let Some(node) = location.and_then(|location| self.metadata.get(&location)) {
            let mut scope = reference(node, "scope: !").and_then(|scope| self.metadata.get(&scope));
            while let Some(block) = scope.filter(|scope| scope.contains("DILexicalBlock")) {
                scope = reference(block, "scope: !").and_then(|scope| self.metadata.get(&scope));
            }
            if let Some(function) = scope
                && let Some(file) = reference(function, "file: !").and_then(|file| self.metadata.get(&file))
            {
                let name = text(function, "name: \"").unwrap_or_default();
                let file = Path::new(text(file, "directory: \"").unwrap_or_default())
                    .join(text(file, "filename: \"").unwrap_or_default());
                let line = reference(node, "line: ").unwrap_or(0);
                frames.push(Frame { function: name.split('<').next().unwrap_or(name), file, line });
            }
            location = reference(node, "inlinedAt: !");
        }
        frames
    }
}

impl Frame<'_> {
    /// Its place, and the package of `packages` that it is in.
    fn place<'p>(&self, packages: &'p [Package]) -> Option<(&'p Package, Place)> {
        let package = packages.iter().filter(|package| self.file.starts_with(package.dir()));
        let package = package.max_by_key(|package| package.dir().as_os_str().len())?;
        let file = self.file.strip_prefix(package.dir()).unwrap_or(&self.file).to_path_buf();
        let name = format!("{} {}", package.name, package.version);
        Some((package, Place { function: self.function.to_string(), package: name, file, line: self.line }))
    }
}

/// The `@symbol` that a line defines.
fn symbol(line: &str) -> Option<&str> {
    let begin = line.find('@')?;
    line[begin..].split(['(', ' ']).next()
}

/// Whether a line names a symbol, and not only one that begins like it.
fn names(line: &str, symbol: &str) -> bool {
    let is_part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '$' | '.');
    line.match_indices(symbol).any(|(at, _)| !line[at + symbol.len()..].starts_with(is_part))
}

/// The number behind `key`.
fn reference(node: &str, key: &str) -> Option<u32> {
    let (_, rest) = node.split_once(key)?;
    rest[..rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len())].parse().ok()
}

/// The string behind `key`, which ends with its opening quote.
fn text<'a>(node: &'a str, key: &str) -> Option<&'a str> {
    node.split_once(key)?.1.split('"').next()
}
