//! Entries: that each program has one, of the right name.

use super::code::Code;
use super::facts::Pipeline;
use super::finding::{Finding, Rule};

pub(super) fn check(code: &Code<'_>, pipelines: &[Pipeline], findings: &mut Vec<Finding>) {
    for pipeline in pipelines {
        for program in &pipeline.programs {
            let mut error =
                |message: String| findings.push(Finding::error(Rule::Entry, program.item(pipeline), message));
            let entry = &program.entry;
            let found: Vec<_> =
                code.0.iter().filter(|function| function.body.is_entry && function.body.name == entry).collect();
            match found[..] {
                [] => error(format!("there is no entry `{entry}`")),
                [one] if one.body.has_parameters && !program.kind.is_callable() => {
                    error(format!("entry `{entry}` has parameters, and OptiX passes none"));
                }
                [_] => {}
                _ => error(format!("there are {} entries `{entry}`", found.len())),
            }
            let prefix = program.kind.prefix();
            if !entry.starts_with(&prefix) {
                error(format!("its entry `{entry}` does not begin with `{prefix}`, as OptiX wants for its kind"));
            }
        }
    }
    let known = |name: &str| pipelines.iter().flat_map(|pipeline| &pipeline.programs).any(|p| p.entry == name);
    for function in code.0.iter().filter(|function| function.body.is_entry && !known(function.body.name)) {
        findings.push(Finding::warning(
            Rule::Entry,
            format!("entry `{}`", function.body.name),
            "no `pipeline!` has this program, so there is nothing to compare it with",
        ));
    }
}
