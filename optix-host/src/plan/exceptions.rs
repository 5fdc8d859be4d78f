//! Which exceptions a pipeline raises (guide 13.14).

use super::depth::Depths;
use super::programs::ReachedProgram;
use core::fmt;
use optix_device_rs::host::PipelineDescription;
use optix_ptx::Module;

/// Which exceptions are raised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Exceptions {
    pub stack_overflow: bool,
    pub trace_depth: bool,
    pub user: bool,
}

impl fmt::Display for Exceptions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let flags = [
            (self.stack_overflow, "stack overflow"),
            (self.trace_depth, "trace depth"),
            (self.user, "user exceptions"),
        ];
        let on: Vec<_> = flags.into_iter().filter(|(on, _)| *on).map(|(_, name)| name).collect();
        f.write_str(&if on.is_empty() { "off".into() } else { on.join(", ") })
    }
}

/// The prefix of the names of the device functions that throw.
const THROW: &str = "_optix_throw_exception_";

impl Exceptions {
    /// The exceptions that a pipeline raises, and why.
    pub(super) fn of(
        description: &PipelineDescription,
        programs: &[ReachedProgram],
        depths: &Depths,
        module: Option<&Module<'_>>,
    ) -> (Self, String) {
        let declared = description.exceptions;
        if !declared.are_declared() {
            return (Self::default(), "the pipeline declares none".into());
        }
        let throws = |module| programs.iter().any(|program| program.calls(module, |name| name.starts_with(THROW)));
        let user = declared.throws.is_some() && module.is_none_or(throws);
        let exceptions = Self { stack_overflow: true, trace_depth: depths.trace_is_stated, user };
        let mut reasons = Vec::new();
        if !depths.trace_is_stated {
            reasons.push("trace calls can't nest deeper than the compiled programs do");
        }
        match declared.throws {
            None => reasons.push("programs throw none"),
            Some(_) if !user => reasons.push("no program that is reached throws"),
            Some(_) => {}
        }
        match declared.program {
            Some(_) => reasons.push("told to the exception program"),
            None => reasons.push("there is no exception program, so the first five of a launch are reported"),
        }
        (exceptions, reasons.join("; "))
    }
}
