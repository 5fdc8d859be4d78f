//! Checks that callables are called, and exceptions thrown, only by programs that may (guide 13).

use optix_ptx::Function;

use super::facts::{Kind, Pipeline, Program};
use super::finding::{Finding, Rule};
use super::place;
use crate::ptx::{CONTINUATION, DIRECT};

const THROW: &str = "_optix_throw_exception_";

pub(super) fn check(
    function: &Function<'_>,
    program: &Program,
    pipeline: &Pipeline,
    item: &str,
    findings: &mut Vec<Finding>,
) {
    for call in function.calls() {
        let allowed = match call.function {
            DIRECT => program.kind != Kind::Exception,
            // The same programs may call continuation callables as may trace, because both suspend the caller.
            CONTINUATION => program.kind.may_trace(),
            name if name.starts_with(THROW) => program.kind != Kind::Exception,
            _ => continue,
        };
        let mut error = |message: &str| findings.push(Finding::error(Rule::Callable, place(function, item), message));
        let (does, is_throw) = match call.function {
            DIRECT => ("calls a direct callable", false),
            CONTINUATION => ("calls a continuation callable", false),
            _ => ("throws an exception", true),
        };
        if !allowed {
            error(&format!("{does}, which OptiX does not allow in a program of its kind"));
        } else if is_throw && pipeline.throws.is_none() {
            error(&format!("throws an exception, but `{}` does not say what its programs throw", pipeline.name));
        }
    }
}
