//! How deep callables nest (guide 6.8).

use super::super::programs::Stage;
use super::Depths;
use super::nesting::{Nesting, NestingError, nesting};
use super::program::{CONTINUATION, CallableKind, DIRECT, Program};
use crate::error::PipelineError;
use crate::limits::MAX_CALLABLE_DEPTH;
use optix_device_rs::host::PipelineDescription;
use std::collections::BTreeSet;

impl Depths {
    /// Adds the depths of callables.
    pub(super) fn add_callables(
        &mut self,
        description: &PipelineDescription,
        programs: Option<&[Program<'_, '_>]>,
    ) -> Result<(), PipelineError> {
        let is_state = |stage| matches!(stage, Stage::RayGen | Stage::Shading(_) | Stage::Continuation);
        let Some(programs) = programs else {
            let depth = description.callable_depth.unwrap_or(MAX_CALLABLE_DEPTH);
            (self.continuation, self.direct_from_traversal, self.direct_from_state) = (depth, depth, depth);
            return Ok(());
        };
        let depth = |kind: &CallableKind, from: fn(Stage) -> bool| {
            let callables: Vec<_> = programs.iter().filter(|program| program.reached.stage == kind.stage).collect();
            let function = |callable: usize| callables[callable].reached.function;
            let (roots, leads_to) = calls(programs, &callables, kind, from);
            match nesting(&leads_to, &roots, description.callable_depth) {
                Ok(Nesting::Known(depth) | Nesting::Stated(depth)) => Ok(depth),
                Err(NestingError::Endless(callable)) => {
                    Err(PipelineError::EndlessCallables { kind: kind.name, callable: function(callable) })
                }
                Err(NestingError::Deeper(chain, stated)) => {
                    let chain = chain.into_iter().map(function).collect();
                    Err(PipelineError::CallableDepth { kind: kind.name, stated, chain })
                }
            }
        };
        self.continuation = depth(&CONTINUATION, is_state)?;
        self.direct_from_traversal = depth(&DIRECT, |stage| matches!(stage, Stage::Traversal(_)))?;
        self.direct_from_state = depth(&DIRECT, is_state)?;
        Ok(())
    }
}

/// Which callables of a kind the programs that run at these places call, and which each callable calls: those that take and
/// give what is called with.
fn calls(
    programs: &[Program<'_, '_>],
    callables: &[&Program<'_, '_>],
    kind: &CallableKind,
    from: fn(Stage) -> bool,
) -> (BTreeSet<usize>, Vec<BTreeSet<usize>>) {
    let called = |program: &Program<'_, '_>| -> BTreeSet<usize> {
        // What can't be read may be any.
        let fits = |callable: &Program<'_, '_>| match (&callable.prototype, &program.called) {
            (Some(prototype), Some(called)) => called.contains(prototype),
            _ => true,
        };
        let all = if program.calls.contains(kind.call) { callables.len() } else { 0 };
        (0..all).filter(|&index| fits(callables[index])).collect()
    };
    let leads_to = callables.iter().map(|callable| called(callable)).collect();
    (programs.iter().filter(|program| from(program.reached.stage)).flat_map(called).collect(), leads_to)
}
