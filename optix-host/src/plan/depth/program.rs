//! What the programs in the PTX trace and call.

use super::super::programs::{ReachedProgram, Stage};
use crate::error::PipelineError;
use optix_ptx::{Function, Module, Prototype};
use std::collections::BTreeSet;

const TRACE: &str = "_optix_trace_typed_32";

/// One of the two kinds of callables.
pub(super) struct CallableKind {
    pub name: &'static str,
    pub stage: Stage,
    /// What the PTX calls to get the address of one.
    pub call: &'static str,
}

pub(super) const DIRECT: CallableKind =
    CallableKind { name: "direct", stage: Stage::Direct, call: "_optix_call_direct_callable" };
pub(super) const CONTINUATION: CallableKind =
    CallableKind { name: "continuation", stage: Stage::Continuation, call: "_optix_call_continuation_callable" };

/// A program and what it does, in functions that it calls too.
pub(super) struct Program<'e, 'a> {
    pub reached: &'e ReachedProgram,
    /// The functions that it calls.
    pub calls: BTreeSet<&'a str>,
    /// The ray types that it traces; `None` where one is not a constant.
    pub traces: Option<BTreeSet<usize>>,
    /// What it takes and gives.
    pub prototype: Option<Prototype>,
    /// What the callables that it calls take and give; `None` where that can't be read.
    pub called: Option<Vec<Prototype>>,
}

pub(super) fn programs<'e, 'a>(
    entries: &'e [ReachedProgram],
    module: &Module<'a>,
) -> Result<Vec<Program<'e, 'a>>, PipelineError> {
    let program = |reached: &'e ReachedProgram| {
        let functions = module.reached(reached.name);
        if functions.is_empty() {
            return Err(PipelineError::MissingEntry { entry: reached.name });
        }
        let calls = functions.iter().flat_map(|function| function.calls()).map(|call| call.function).collect();
        let prototype = functions[0].prototype.clone();
        Ok(Program { reached, calls, traces: traced(&functions), prototype, called: called(&functions) })
    };
    entries.iter().map(program).collect()
}

/// The ray types that functions trace: the bits of `OptixPayloadTypeID`, which is the first argument of each trace call.
/// `None` where one is not a constant.
fn traced(functions: &[&Function<'_>]) -> Option<BTreeSet<usize>> {
    let calls = functions.iter().flat_map(|function| function.calls()).filter(|call| call.function == TRACE);
    calls.map(|call| Some((*call.values.first()?)?.trailing_zeros() as usize)).collect()
}

/// The prototypes by which functions call callables. `None` where one can't be read.
fn called(functions: &[&Function<'_>]) -> Option<Vec<Prototype>> {
    let is_callable = |name: &str| [&DIRECT, &CONTINUATION].iter().any(|kind| kind.call == name);
    let calls = functions.iter().flat_map(|function| function.calls()).filter(|call| is_callable(call.function));
    let prototypes =
        functions.iter().map(|function| function.called_prototypes()).collect::<Option<Vec<_>>>()?.concat();
    (prototypes.len() >= calls.count()).then_some(prototypes)
}
