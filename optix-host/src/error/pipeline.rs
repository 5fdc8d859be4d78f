//! Why a pipeline can't be built for a scene and a device.

use super::ReferenceError;
use super::words::{Words, errors};
use crate::limits::MAX_TRACE_DEPTH;

/// What is wrong with a pipeline.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub enum PipelineError {
    /// OptiX, and no PTX.
    NoPtx,
    /// A program reads a record that the scene was not given.
    MissingRecord {
        /// The kind of the program.
        kind: &'static str,
        /// The function.
        program: &'static str,
        /// The record's type.
        record: &'static str,
        /// The call that gives it.
        call: String,
    },
    /// A record holds a structure or a callable that this pipeline's programs can't use.
    Record(ReferenceError),
    /// PTX without the table of the pipeline's layouts.
    NoLayouts {
        /// The name of the table.
        table: &'static str,
    },
    /// PTX in which more or fewer types cross between host and device.
    CrossingCount {
        /// How many there are in the PTX.
        ptx: usize,
        /// How many there are in this host.
        host: usize,
    },
    /// Types that are laid out in the PTX in another way than in this host.
    Layouts(Vec<LayoutDifference>),
    /// A program of the pipeline that the PTX does not have.
    MissingEntry {
        /// The name of its entry function.
        entry: &'static str,
    },
    /// `trace_depth` in the declaration is more than OptiX has.
    TraceDepthLimit {
        /// What is stated.
        stated: u32,
    },
    /// A trace call of which it can't be read what it traces, and no `trace_depth` in the declaration.
    UnknownTraceDepth {
        /// The program with the call.
        program: &'static str,
    },
    /// Rays that lead to rays of their own type, and no `trace_depth` in the declaration.
    EndlessTraces {
        /// The payload of such a ray.
        ray: &'static str,
    },
    /// `trace_depth` in the declaration is less than the programs trace.
    TraceDepth {
        /// What is stated.
        stated: u32,
        /// The longest chain of trace calls: each program, and the payload of the ray that it traces.
        chain: Vec<(&'static str, &'static str)>,
    },
    /// Callables that call themselves, and no `callable_depth` in the declaration.
    EndlessCallables {
        /// Direct or continuation.
        kind: &'static str,
        /// One of the callables.
        callable: &'static str,
    },
    /// `callable_depth` in the declaration is less than the callables nest.
    CallableDepth {
        /// Direct or continuation.
        kind: &'static str,
        /// What is stated.
        stated: u32,
        /// The longest chain: each calls the next.
        chain: Vec<&'static str>,
    },
    /// A payload whose words have semantics that OptiX does not have.
    PayloadSemantics {
        /// The payload.
        payload: &'static str,
    },
}

/// How a type that crosses between host and device is laid out in the PTX, and how in this host.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct LayoutDifference {
    /// What it is used as, such as `record`.
    pub what: &'static str,
    /// The type.
    pub name: &'static str,
    /// Its size in the PTX.
    pub ptx: u64,
    /// Its size in this host. Where both are equal the fields differ.
    pub host: u64,
    /// What sizes are counted in.
    pub unit: &'static str,
}

impl std::fmt::Display for LayoutDifference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { what, name, ptx, host, unit } = self;
        if ptx == host {
            write!(f, "{what} `{name}`: {host} {unit} in both, but with other fields")
        } else {
            write!(f, "{what} `{name}`: {ptx} {unit} there, {host} here")
        }
    }
}

impl PipelineError {
    fn words(&self) -> Words {
        let same_source = "build both from the same source, in which no `#[cfg(..)]` and no constant makes a type different for the \
                           device";
        let state_trace_depth =
            "state `trace_depth: N` in `pipeline!`, the most trace calls that run one inside the other";
        let another_build = |what: String| format!("the PTX is of another build than this host: {what}");
        match self {
            Self::NoPtx => (
                "OptiX needs the PTX of the shaders, and was given none".into(),
                "give it with `.ptx(optix_host::ptx!(..))`; where that is empty, run `cargo optix setup` and build again".into(),
            ),
            Self::MissingRecord { kind, program, record, call } => (
                format!("the {kind} program `{program}` reads a record `{record}` that the scene was not given"),
                format!("call `{call}` before the pipeline is built").into(),
            ),
            Self::Record(error) => (format!("a record holds {}", error.problem()), error.remedy()),
            Self::NoLayouts { table } => (
                another_build(format!("it does not have the pipeline's layouts, `{table}`")),
                same_source.into(),
            ),
            Self::CrossingCount { ptx, host } => (
                another_build(format!("{ptx} types cross between host and device there, and {host} here")),
                same_source.into(),
            ),
            Self::Layouts(differences) => {
                let differences: Vec<_> = differences.iter().map(LayoutDifference::to_string).collect();
                (another_build(differences.join("; ")), same_source.into())
            }
            Self::MissingEntry { entry } => (
                format!("the PTX has no entry {entry}: it is of another build or crate than the host's pipeline"),
                "give the PTX of the crate that declares the pipeline, and build both again".into(),
            ),
            Self::TraceDepthLimit { stated } => (
                format!("`trace_depth: {stated}` is stated in `pipeline!`, more than the {MAX_TRACE_DEPTH} of OptiX (guide 12)"),
                "trace further rays in a loop in the ray-generation program".into(),
            ),
            Self::UnknownTraceDepth { program } => (
                format!("the payload type of a trace call in `{program}` is not a constant, so the trace depth is not known"),
                state_trace_depth.into(),
            ),
            Self::EndlessTraces { ray } => (
                format!(
                    "its programs trace rays recursively, and a ray `{ray}` can lead to another, so nothing bounds the trace depth"
                ),
                state_trace_depth.into(),
            ),
            Self::TraceDepth { stated, chain } => {
                let steps: Vec<_> = chain.iter().map(|(program, ray)| format!("`{program}` traces `{ray}`")).collect();
                (
                    format!(
                        "`trace_depth: {stated}` is stated in `pipeline!`, but its programs trace rays {} deep: {}",
                        chain.len(),
                        steps.join(", ")
                    ),
                    format!(
                        "state {} or more, or leave `trace_depth` out, which makes it what the programs need",
                        chain.len()
                    )
                    .into(),
                )
            }
            Self::EndlessCallables { kind, callable } => (
                format!(
                    "its {kind} callables call each other, and `{callable}` can come to be called inside of itself, so nothing \
                     bounds how deep"
                ),
                "state `callable_depth: N` in `pipeline!`, the most callables that run one inside the other".into(),
            ),
            Self::CallableDepth { kind, stated, chain } => {
                let callables: Vec<_> = chain.iter().map(|callable| format!("`{callable}`")).collect();
                (
                    format!(
                        "`callable_depth: {stated}` is stated in `pipeline!`, but its {kind} callables can be called {} deep: {}",
                        chain.len(),
                        callables.join(" calls ")
                    ),
                    format!("state {} or more, or call callables of another signature there", chain.len()).into(),
                )
            }
            Self::PayloadSemantics { payload } => (
                format!("payload `{payload}` has semantics bits that OptiX does not know"),
                "make the payload with `#[derive(Payload)]`".into(),
            ),
        }
    }
}

errors!(PipelineError);
