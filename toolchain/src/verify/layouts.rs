//! Checks that host and device lay out what crosses between them in the same way.

use optix_ptx::Module;

use super::facts::Pipeline;
use super::finding::{Finding, Rule};

pub(super) fn check(module: &Module<'_>, pipeline: &Pipeline, findings: &mut Vec<Finding>) {
    let of = &pipeline.name;
    let mut error = |item: String, message: String| findings.push(Finding::error(Rule::Layout, item, message));
    let Some(variable) = module.variables.iter().find(|variable| variable.name == pipeline.layouts) else {
        let message = format!("the PTX does not have its layouts, `{}`", pipeline.layouts);
        return error(format!("pipeline `{of}`"), message);
    };
    let numbers = variable.numbers();
    let (there, _) = numbers.as_chunks::<2>();
    if there.len() != pipeline.crossings.len() {
        let message = format!("{} types cross in the PTX, {} on the host", there.len(), pipeline.crossings.len());
        return error(format!("pipeline `{of}`"), message);
    }
    for (here, &[size, layout]) in pipeline.crossings.iter().zip(there) {
        let unit = &here.unit;
        let message = if size != here.size as u64 {
            format!("the PTX has {size} {unit} of it, the host {}", here.size)
        } else if layout != here.layout {
            format!("of its {size} {unit} the PTX makes other fields than the host")
        } else {
            continue;
        };
        error(format!("{} `{}` of `{of}`", here.what, here.name), message);
    }
}
