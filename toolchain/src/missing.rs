//! Finds which crate, function and line uses something that the device does not have.
//!
//! After optimisation, everything is inlined into the entry, so the PTX only tells that an entry calls the missing
//! function. But LLVM IR with line information tells for each instruction which functions it was inlined from. So the
//! crate is compiled again that way.

use std::fmt;
use std::path::PathBuf;

use optix_llvm_ir::model::{Call, Callee, Function, Instruction, Op, Type, Value};
use optix_llvm_ir::opcode::Cast;
use optix_llvm_ir::{Frame, Origins};

use crate::metadata::Package;
use crate::wrapper::NO_HEAP;

/// Something that a shader crate uses and the device does not have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Culprit {
    /// What is missing.
    pub what: Missing,
    /// The function that uses it. It is the innermost one that is in a package, and not in the standard library.
    pub at: SourceLocation,
    /// The function of the shader crate that leads there, if the use is in another package.
    pub from: Option<SourceLocation>,
}

/// What is missing.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Missing {
    /// Memory that is allocated at run time.
    Heap,
    /// A function with this name, which is defined nowhere.
    Function(String),
    /// Calls through pointers.
    Pointers,
    /// A function that calls itself and also calls device functions.
    Recursion,
    /// Conversions between floats and 128-bit integers.
    WideConversion,
}

/// A place in the source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceLocation {
    /// The function's name.
    pub function: String,
    /// The name and version of its package.
    pub package: String,
    /// The file, relative to the package.
    pub file: PathBuf,
    /// The line, from 1.
    pub line: u32,
}

impl fmt::Display for SourceLocation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` of {} ({}:{})", self.function, self.package, self.file.display(), self.line)
    }
}

impl Culprit {
    /// What is wrong, and where.
    pub fn problem(&self) -> String {
        let Self { what, at, from } = self;
        let problem = match what {
            Missing::Heap => format!("the device has no heap, and {at} allocates"),
            Missing::Function(name) => format!("nothing on the device defines `{name}`, which {at} calls"),
            Missing::Pointers => format!("OptiX does not call functions through pointers, as {at} does"),
            Missing::Recursion => {
                format!("OptiX does not let a recursive function call device functions, as {at} does")
            }
            Missing::WideConversion => {
                format!("the device can't convert between floats and 128-bit integers, as {at} does")
            }
        };
        match from {
            Some(from) => format!("{problem}, for {from}"),
            None => problem,
        }
    }
}

impl fmt::Display for Culprit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}", self.problem(), self.what.remedy())
    }
}

/// The first of `missing` that a function in the IR of a device build uses, with the place. The places are of
/// `packages`; other code, such as the standard library's, is passed over. The shader crate is `own`.
pub(crate) fn culprit(ir: &str, missing: &[Missing], packages: &[Package], own: &Package) -> Option<Culprit> {
    let module = optix_llvm_ir::known(ir);
    let find =
        |what: &Missing| module.instructions().find(|(function, instruction)| what.is_used(function, instruction));
    let (what, (function, instruction)) = missing.iter().find_map(|what| Some((what, find(what)?)))?;
    let frames = Origins::new(&module).of(function, instruction);
    let locations: Vec<(&Package, SourceLocation)> =
        frames.iter().filter_map(|frame| location(frame, packages)).collect();
    let (package, at) = locations.first()?.clone();
    let from = locations.into_iter().find(|(package, _)| package.id == own.id).map(|(_, location)| location);
    Some(Culprit { what: what.clone(), at, from: from.filter(|_| package.id != own.id) })
}

impl Missing {
    /// What to do about it.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::Heap => "use arrays or collections of fixed size, or pass a view of a buffer that the host allocates",
            Self::Function(_) => {
                "use another function, or `#[cfg(not(target_arch = \"nvptx64\"))]` where only the host calls it"
            }
            Self::Pointers => {
                "use generics, an enum or a callable in place of a `dyn` object or `fn` pointer, and format nothing"
            }
            Self::Recursion => "use a loop",
            Self::WideConversion => "convert by way of 64 bits",
        }
    }

    /// What is missing if this symbol is unresolved in the PTX.
    pub(crate) fn of_symbol(symbol: &str) -> Self {
        if symbol == NO_HEAP { Self::Heap } else { Self::Function(symbol.to_string()) }
    }

    /// Whether the instruction, which is in that function, uses the thing that is missing.
    fn is_used(&self, function: &Function, instruction: &Instruction) -> bool {
        const WIDE: Type = Type::Int(128);
        match (self, &instruction.op) {
            (Self::Heap, Op::Call(call)) => names(call, NO_HEAP),
            (Self::Function(name), Op::Call(call)) => names(call, name),
            (Self::Recursion, Op::Call(call)) => names(call, &function.name),
            (Self::Pointers, Op::Call(call)) => matches!(call.callee, Callee::Function(Value::Local(_))),
            (Self::WideConversion, Op::Cast { op: Cast::UIToFP | Cast::SIToFP, value, .. }) => {
                *value.ty.element() == WIDE
            }
            (Self::WideConversion, Op::Cast { op: Cast::FPToUI | Cast::FPToSI, to, .. }) => *to.element() == WIDE,
            (Self::WideConversion, Op::Call(call)) => call.name().is_some_and(|name| {
                ["llvm.fptoui.sat.", "llvm.fptosi.sat."].iter().any(|saturating| name.starts_with(saturating))
                    && *call.result.element() == WIDE
            }),
            _ => false,
        }
    }
}

/// Whether the call calls that function, or passes its address.
fn names(call: &Call, symbol: &str) -> bool {
    let mut found = call.name() == Some(symbol);
    let arguments = call.arguments.iter().map(|argument| &argument.value.value);
    arguments.for_each(|value| value.globals(&mut |name| found |= name == symbol));
    found
}

/// The location of a frame, and the package of `packages` that it is in.
fn location<'p>(frame: &Frame<'_>, packages: &'p [Package]) -> Option<(&'p Package, SourceLocation)> {
    let package = packages.iter().filter(|package| frame.file.starts_with(package.dir()));
    let package = package.max_by_key(|package| package.dir().as_os_str().len())?;
    let file = frame.file.strip_prefix(package.dir()).unwrap_or(&frame.file).to_path_buf();
    let name = format!("{} {}", package.name, package.version);
    Some((package, SourceLocation { function: frame.function.to_string(), package: name, file, line: frame.line }))
}
