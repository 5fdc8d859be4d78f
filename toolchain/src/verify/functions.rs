//! Finds what is not wrong but costs time: local memory, and functions that are called instead of inlined.

use optix_ptx::{Call, Function, Module};

use super::facts::Pipeline;
use super::finding::{Finding, Rule};
use super::trace;
use crate::libm::OUT_OF_LINE;
use crate::ptx::{demangled, is_callable_call};

/// Whether a call goes through a pointer that is not a callable's.
fn is_through_a_pointer(function: &Function<'_>, call: &Call<'_>) -> bool {
    let is_callable = |other: &Call<'_>| is_callable_call(other) && other.results.contains(&call.function);
    call.function.starts_with('%') && !function.calls().iter().any(is_callable)
}

pub(super) fn check(module: &Module<'_>, pipelines: &[Pipeline], allowed: &[String], findings: &mut Vec<Finding>) {
    let item = |name: &str| {
        let mut programs = pipelines.iter().flat_map(|pipeline| pipeline.programs.iter().map(move |p| (pipeline, p)));
        let program = programs.find(|(_, program)| program.entry == name);
        program.map(|(pipeline, program)| program.item(pipeline))
    };
    for function in module.defined() {
        let name = function.name;
        let place = || match item(name) {
            Some(item) => item,
            None if function.is_entry => format!("entry `{name}`"),
            None => format!("function `{}`", demangled(name)),
        };
        let runs = |pipeline: &&Pipeline| pipeline.programs.iter().any(|program| program.entry == name);
        let pipelines = pipelines.iter().filter(|pipeline| !function.is_entry || runs(pipeline));
        let payloads = pipelines.map(|pipeline| trace::payload_memory(function, pipeline)).max().unwrap_or(0);
        if let Some(bytes) = function.local_memory().filter(|bytes| *bytes > payloads) {
            let payloads = if payloads > 0 { format!(", {payloads} of them for payloads") } else { String::new() };
            let message = format!("keeps {bytes} bytes in local memory{payloads}");
            findings.push(Finding::error(Rule::LocalMemory, place(), message));
        }
        if function.calls().iter().any(|call| is_through_a_pointer(function, call)) {
            findings.push(Finding::error(Rule::Call, place(), "calls a function through a pointer"));
        }
    }
    for function in module.defined().filter(|function| !function.is_entry) {
        let name = function.name;
        let path = demangled(name);
        let callers = module.defined().filter(|caller| caller.calls().iter().any(|call| call.function == name));
        let callers: Vec<String> = callers
            .map(|caller| item(caller.name).unwrap_or_else(|| format!("`{}`", demangled(caller.name))))
            .collect();
        let meant =
            OUT_OF_LINE.contains(&path.as_str()) || allowed.iter().any(|allowed| path.contains(allowed.as_str()));
        if !callers.is_empty() && !meant {
            let message = format!("is called, not inlined, by {}", callers.join(" and by "));
            findings.push(Finding::error(Rule::Call, format!("function `{path}`"), message));
        }
    }
}
