//! What costs without being wrong: local memory, and functions that are called instead of inlined.

use super::callables;
use super::code::{Code, Function};
use super::facts::Pipeline;
use super::finding::{Finding, Rule};
use super::trace;
use crate::ptx::calls::{Call, demangled};

/// Whether a call goes through a pointer that is not that of a callable.
fn is_through_a_pointer(function: &Function<'_>, call: &Call<'_>) -> bool {
    let is_callable = |other: &Call<'_>| callables::is_call(other) && other.results.contains(&call.function);
    call.function.starts_with('%') && !function.calls.iter().any(is_callable)
}

pub(super) fn check(code: &Code<'_>, pipelines: &[Pipeline], allowed: &[String], findings: &mut Vec<Finding>) {
    let item = |name: &str| {
        let mut programs = pipelines.iter().flat_map(|pipeline| pipeline.programs.iter().map(move |p| (pipeline, p)));
        let program = programs.find(|(_, program)| program.entry == name);
        program.map(|(pipeline, program)| program.item(pipeline))
    };
    for function in &code.0 {
        let name = function.body.name;
        let place = || match item(name) {
            Some(item) => item,
            None if function.body.is_entry => format!("entry `{name}`"),
            None => format!("function `{}`", demangled(name)),
        };
        let runs = |pipeline: &&Pipeline| pipeline.programs.iter().any(|program| program.entry == name);
        let pipelines = pipelines.iter().filter(|pipeline| !function.body.is_entry || runs(pipeline));
        let payloads = pipelines.map(|pipeline| trace::payload_memory(function, pipeline)).max().unwrap_or(0);
        if let Some(bytes) = function.body.local_memory().filter(|bytes| *bytes > payloads) {
            let payloads = if payloads > 0 { format!(", {payloads} of them for payloads") } else { String::new() };
            let message = format!("keeps {bytes} bytes in local memory{payloads}");
            findings.push(Finding::error(Rule::LocalMemory, place(), message));
        }
        if function.calls.iter().any(|call| is_through_a_pointer(function, call)) {
            findings.push(Finding::error(Rule::Call, place(), "calls a function through a pointer"));
        }
    }
    for function in code.0.iter().filter(|function| !function.body.is_entry) {
        let name = function.body.name;
        let path = demangled(name);
        let callers = code.0.iter().filter(|caller| caller.calls.iter().any(|call| call.function == name));
        let callers: Vec<String> = callers
            .map(|caller| item(caller.body.name).unwrap_or_else(|| format!("`{}`", demangled(caller.body.name))))
            .collect();
        if !callers.is_empty() && !allowed.iter().any(|allowed| path.contains(allowed.as_str())) {
            let message = format!("is called, not inlined, by {}", callers.join(" and by "));
            findings.push(Finding::error(Rule::Call, format!("function `{path}`"), message));
        }
    }
}
