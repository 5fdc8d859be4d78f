//! Checks that each program has an entry with the right name.

use optix_ptx::Module;

use super::facts::Pipeline;
use super::finding::{Finding, Rule};

pub(super) fn check(module: &Module<'_>, pipelines: &[Pipeline], findings: &mut Vec<Finding>) {
    for pipeline in pipelines {
        for program in &pipeline.programs {
            let mut error =
                |message: String| findings.push(Finding::error(Rule::Entry, program.item(pipeline), message));
            let entry = &program.entry;
            let found: Vec<_> =
                module.defined().filter(|function| function.is_entry && function.name == entry).collect();
            match found[..] {
                [] => error(format!("there is no entry `{entry}`")),
                [one] if one.has_parameters && !program.kind.is_callable() => {
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
    for function in module.defined().filter(|function| function.is_entry && !known(function.name)) {
        findings.push(Finding::warning(
            Rule::Entry,
            format!("entry `{}`", function.name),
            "no `pipeline!` has this program, so there is nothing to compare it with",
        ));
    }
}
