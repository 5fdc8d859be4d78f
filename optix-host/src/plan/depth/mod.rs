//! How deep calls nest (guide 6.7, 6.8): by what the declaration says, and by what the programs in the PTX do.

mod callable;
mod nesting;
mod program;
#[cfg(test)]
mod tests;
mod trace;

use super::explain::Notes;
use super::programs::ReachedProgram;
use crate::{Error, Result};
use optix_device_rs::host::PipelineDescription;
use optix_ptx::Module;

/// How deep calls nest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Depths {
    /// Trace calls.
    pub trace: u32,
    /// Whether the trace depth holds only because the declaration says so: the programs may trace deeper, for all that can be seen.
    pub trace_is_stated: bool,
    /// Continuation callables.
    pub continuation: u32,
    /// Direct callables below any-hit and intersection programs.
    pub direct_from_traversal: u32,
    /// Direct callables below other programs.
    pub direct_from_state: u32,
}

impl Depths {
    /// From what the declaration says, and from the programs in the PTX where it says nothing.
    pub(super) fn new(
        description: &PipelineDescription,
        reached: &[ReachedProgram],
        module: Option<&Module<'_>>,
        notes: &mut Notes,
    ) -> Result<Self> {
        let error = |error| Error::Pipeline { pipeline: description.name, error };
        let programs = module.map(|module| program::programs(reached, module).map_err(error)).transpose()?;
        let programs = programs.as_deref();
        let (trace, is_stated, why) = trace::trace_depth(description, programs).map_err(error)?;
        notes.add("trace depth", trace.to_string(), why);
        let mut depths =
            Self { trace, trace_is_stated: is_stated, continuation: 0, direct_from_traversal: 0, direct_from_state: 0 };
        if !description.callables.is_empty() {
            depths.add_callables(description, programs).map_err(error)?;
            let Self { continuation, direct_from_traversal, direct_from_state, .. } = depths;
            notes.add(
                "callable depth",
                format!(
                    "{continuation} continuation, {direct_from_state} direct, {direct_from_traversal} during traversal"
                ),
                match (description.callable_depth, programs) {
                    (None, None) => "the most there is: without PTX it is not known which programs call",
                    (Some(_), None) => "stated in the pipeline's declaration",
                    (Some(_), Some(_)) => {
                        "the longest chain of calls in the compiled programs, or where that has no end what the declaration states"
                    }
                    (None, Some(_)) => "the longest chain of calls in the compiled programs",
                },
            );
        }
        Ok(depths)
    }

    /// The most callables that may run inside one another between two trace calls.
    pub fn callables(&self) -> u32 {
        self.continuation + self.direct_from_state.max(self.direct_from_traversal)
    }
}
