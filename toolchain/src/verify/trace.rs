//! Checks that everything in a trace call follows from its ray type.

use optix_ptx::{Call, Function};

use super::facts::{Pipeline, Program};
use super::finding::{Finding, Rule};
use super::place;
const TRACE: &str = "_optix_trace_typed_32";

/// Positions of the arguments of `_optix_trace_typed_32`. Before the offset are type, handle, nine numbers of the ray,
/// mask and flags; the words themselves come after the word count.
const TYPE: usize = 0;
const SBT_OFFSET: usize = 13;
const SBT_STRIDE: usize = 14;
const MISS_INDEX: usize = 15;
const WORDS: usize = 16;
const ARGUMENTS: usize = 49;

pub(super) fn check(
    function: &Function<'_>,
    program: &Program,
    pipeline: &Pipeline,
    item: &str,
    findings: &mut Vec<Finding>,
) {
    for call in function.calls().iter().filter(|call| call.function.starts_with("_optix_trace")) {
        let mut error = |message: String| findings.push(Finding::error(Rule::Trace, place(function, item), message));
        if !program.kind.may_trace() {
            error("traces a ray, which OptiX does not allow in a program of its kind".into());
        }
        if call.function != TRACE {
            error(format!("calls `{}`, of which nothing can be proven here", call.function));
        } else if call.arguments.len() != ARGUMENTS {
            error(format!("passes {} arguments to `{TRACE}`, which takes {ARGUMENTS}", call.arguments.len()));
        } else {
            check_call(call, pipeline, &mut error);
        }
    }
}

/// The bytes of payloads that the function keeps in its local memory, for those of its rays whose payload travels by
/// pointer.
pub(super) fn payload_memory(function: &Function<'_>, pipeline: &Pipeline) -> usize {
    let calls = function.calls().iter().filter(|call| call.function == TRACE);
    let rays = calls.filter_map(|call| pipeline.rays.get(call.values.get(TYPE).copied()??.trailing_zeros() as usize));
    rays.map(|ray| (ray.memory_words * 4).next_multiple_of(16)).sum()
}

fn check_call(call: &Call<'_>, pipeline: &Pipeline, error: &mut impl FnMut(String)) {
    let Some(types) = call.values[TYPE] else {
        error("traces a ray whose payload type is not a constant".into());
        return;
    };
    let index = types.trailing_zeros();
    let Some(ray) = pipeline.rays.get(index as usize).filter(|_| types.is_power_of_two()) else {
        error(format!("traces a ray of payload type {types}, which is no ray type of `{}`", pipeline.name));
        return;
    };
    let expected = [
        (SBT_OFFSET, "SBT offset", index as usize),
        (SBT_STRIDE, "SBT stride", pipeline.rays.len()),
        (MISS_INDEX, "miss index", index as usize),
        (WORDS, "payload word count", ray.semantics.len()),
    ];
    for (position, what, expected) in expected {
        match call.values[position] {
            Some(value) if value as usize == expected => {}
            Some(value) => {
                error(format!("traces a ray `{}` with {what} {value} in place of {expected}", ray.payload));
            }
            None => error(format!("traces a ray `{}`, and its {what} is not a constant", ray.payload)),
        }
    }
}
