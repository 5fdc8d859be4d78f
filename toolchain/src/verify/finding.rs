//! The findings of a verification.

use std::fmt;

use super::facts::{Kind, Pipeline, Program};

/// Something wrong with a PTX.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// How bad it is.
    pub level: Level,
    /// Which rule is broken.
    pub rule: Rule,
    /// The Rust item: "closest-hit program `surface::lambert` of `PathTracer` (..)".
    pub item: String,
    /// What is wrong with it.
    pub message: String,
}

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// A contract is broken, or it can't be proven that it is kept.
    Error,
    /// It works, but it costs time.
    Warning,
}

/// What must hold; see the [module](super).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Rule {
    /// The module could be loaded.
    Module,
    /// Entries and their names.
    Entry,
    /// The variable that holds the launch parameters.
    ParamsSymbol,
    /// How types that cross between host and device are laid out.
    Layout,
    /// Loads of launch parameters.
    ParamsLoad,
    /// `_optix_set_payload_types`.
    PayloadType,
    /// `_optix_get_payload` and `_optix_set_payload`.
    PayloadWord,
    /// `_optix_trace_typed_32`.
    Trace,
    /// Queries about the primitive that was hit.
    Primitive,
    /// Local memory.
    LocalMemory,
    /// Calls of functions.
    Call,
    /// Calls of callables, and throwing.
    Callable,
    /// Instructions that OptiX forbids or gives another meaning.
    Instruction,
}

impl Rule {
    /// Its name on the command line and in JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Module => "module",
            Self::Entry => "entry",
            Self::ParamsSymbol => "params-symbol",
            Self::Layout => "layout",
            Self::ParamsLoad => "params-load",
            Self::PayloadType => "payload-type",
            Self::PayloadWord => "payload-word",
            Self::Trace => "trace",
            Self::Primitive => "primitive",
            Self::LocalMemory => "local-memory",
            Self::Call => "call",
            Self::Callable => "callable",
            Self::Instruction => "instruction",
        }
    }

    /// What to do about a finding of this rule.
    pub const fn help(self) -> &'static str {
        match self {
            Self::Module => "avoid what needs it, or define it in the shader crate",
            Self::Entry | Self::ParamsSymbol => {
                "entries and parameters are made by `pipeline!` and `#[launch_params]`; if nothing was written by hand, \
                 host and device see different declarations: look for `#[cfg]` on what they are made from"
            }
            Self::Layout => {
                "one source gives host and device different types: look for `#[cfg(..)]` on fields, and for constants and aliases \
                 that depend on the target, in this type and in the types of its fields"
            }
            Self::Primitive => {
                "read what the intersection program reported, `hit.attributes()`; vertices, barycentrics and faces are for \
                 materials on `Triangles`"
            }
            Self::ParamsLoad => {
                "read parameters through `params()`, one field at a time; a field of at most 128 bytes, of numbers of 4 \
                 bytes or more, is loaded directly, and only direct loads can be specialised"
            }
            Self::PayloadType | Self::PayloadWord | Self::Trace => {
                "these calls are made by `pipeline!` and `trace`; if nothing was written by hand, host and device see \
                 different declarations: look for `#[cfg]` on payload fields and ray types"
            }
            Self::LocalMemory => {
                "an array that is indexed by a run-time value, or a value whose address is passed on, lies in local \
                 memory: index by constants, unroll, or pass by value"
            }
            Self::Callable => {
                "these calls are made by `Callable::call` and `throw`, which a program's context allows or not; look for code \
                 that was written by hand"
            }
            Self::Instruction => {
                "no function of the device crate has it: look for `asm!`, in crates that are used too, and for atomics on what is no \
                 memory behind a view"
            }
            Self::Call => {
                "mark the function `#[inline]`, or allow the call by `--allow-function NAME` if it is meant to be one"
            }
        }
    }
}

impl Finding {
    pub(super) fn error(rule: Rule, item: impl Into<String>, message: impl Into<String>) -> Self {
        Self { level: Level::Error, rule, item: item.into(), message: message.into() }
    }

    pub(super) fn warning(rule: Rule, item: impl Into<String>, message: impl Into<String>) -> Self {
        Self { level: Level::Warning, ..Self::error(rule, item, message) }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let level = match self.level {
            Level::Error => "error",
            Level::Warning => "warning",
        };
        write!(f, "{level}[{}]: {}: {}", self.rule.name(), self.item, self.message)
    }
}

impl Program {
    /// The name of the program in findings.
    pub(super) fn item(&self, pipeline: &Pipeline) -> String {
        let kind = match self.kind {
            Kind::RayGen => "ray-generation program",
            Kind::Miss => "miss program",
            Kind::ClosestHit => "closest-hit program",
            Kind::AnyHit => "any-hit program",
            Kind::Intersection => "intersection program",
            Kind::DirectCallable => "direct callable",
            Kind::ContinuationCallable => "continuation callable",
            Kind::Exception => "exception program",
        };
        let material = self.material.as_ref().map(|material| format!("material `{material}`"));
        let ray = self.ray.and_then(|ray| pipeline.rays.get(ray)).map(|ray| format!("ray `{}`", ray.payload));
        let place: Vec<String> = material.into_iter().chain(ray).collect();
        let place = if place.is_empty() { String::new() } else { format!(" ({})", place.join(", ")) };
        format!("{kind} `{}` of `{}`{place}", self.function, pipeline.name)
    }
}
