//! Finds instructions that OptiX forbids or gives another meaning, for every program that reaches them.

use optix_ptx::Function;

use super::finding::{Finding, Rule};
use super::place;
use crate::ptx::Forbidden;

pub(super) fn check(function: &Function<'_>, found: &[Forbidden], item: &str, findings: &mut Vec<Finding>) {
    for one in found.iter().filter(|one| one.function == function.name) {
        let finding = if one.why.is_error() { Finding::error } else { Finding::warning };
        findings.push(finding(Rule::Instruction, place(function, item), one.to_string()));
    }
}
