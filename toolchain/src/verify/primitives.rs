//! Queries of hits: that a program asks about its own kind of primitive only (guide 13.9). Which functions ask about which kind
//! is known where the kind is: the host's description says it.

use optix_ptx::Function;

use super::facts::Program;
use super::finding::{Finding, Rule};
use super::place;

pub(super) fn check(function: &Function<'_>, program: &Program, item: &str, findings: &mut Vec<Finding>) {
    let Some(primitive) = &program.primitive else { return };
    let is_undefined = |name: &str| program.undefined.iter().any(|other| other == name);
    for call in function.calls().iter().filter(|call| is_undefined(call.function)) {
        let message = format!("calls `{}`, which is undefined for hits on `{primitive}`", call.function);
        findings.push(Finding::error(Rule::Primitive, place(function, item), message));
    }
}
