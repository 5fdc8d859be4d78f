//! Pipelines: linked programs and their stacks (guide 6.7, 6.8).

use std::sync::{Arc, Mutex};

use super::compile_log::CompileLog;
use super::context::Context;
use super::launch::Slot;
use super::module_options::or_null;
use super::options::PipelineOptions;
use super::program::ProgramGroup;
use super::stack::{self, CallDepths, GroupStack, StackSizes};
use super::sys;
use crate::error::DriverError as Error;

/// How a pipeline is linked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinkOptions {
    /// How deep traces and callables nest. The trace depth is at most [`Limits::max_trace_depth`](super::Limits).
    pub depths: CallDepths,
    /// Traversables on the longest path from a traced root to a leaf: 1 for a lone geometry acceleration structure, 2 for
    /// one level of instances, and one more for each transform and each level of instances between.
    pub max_graph_depth: u32,
    /// The stack sizes, if the caller knows better ones than those of [`stack::compute`] and
    /// [`stack::traversal_reserve`].
    pub stack: Option<StackSizes>,
}

/// A linked pipeline. Cheap to clone; keeps its program groups alive.
#[derive(Clone, Debug)]
pub struct Pipeline(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    raw: sys::OptixPipeline,
    stack: StackSizes,
    groups_stack: GroupStack,
    log: String,
    /// Parameter memory of finished launches, to be used again.
    slots: Mutex<Vec<Slot>>,
    _groups: Vec<ProgramGroup>,
    context: Context,
}

impl Pipeline {
    /// Links the groups and sets the stack sizes.
    ///
    /// # Errors
    /// [`Error::Invalid`] for groups of another context or other pipeline options and for depths beyond the limits,
    /// [`Error::Optix`] with the log otherwise.
    pub fn new(
        context: &Context,
        groups: &[ProgramGroup],
        options: &PipelineOptions,
        link: &LinkOptions,
    ) -> Result<Self, Error> {
        check_groups(context, groups, options)?;
        link.check(context, options)?;
        let count = u32::try_from(groups.len())
            .map_err(|_| Error::invalid("a pipeline", "it has more than 2^32 program groups", "link fewer groups"))?;
        let raw_groups: Vec<_> = groups.iter().map(ProgramGroup::raw).collect();
        let raw_options = options.raw(context)?;
        let link_options = sys::OptixPipelineLinkOptions { max_trace_depth: link.depths.trace };
        let mut log = CompileLog::new();
        let mut raw = sys::OptixPipeline::NULL;
        let _current = context.enter()?;
        let (log_text, log_size) = log.parts();
        // SAFETY: the context and the groups are live; the options and the array live until the end of this block; the
        // log buffer is as long as its size says.
        let result = unsafe {
            let (options, groups) = (&raw_options.options, or_null(&raw_groups));
            let table = context.table();
            table.pipeline_create(context.raw(), options, &link_options, groups, count, log_text, log_size, &mut raw)
        };
        context.check_compile("optixPipelineCreate", result, &log)?;
        // From here on, dropping `inner` destroys the pipeline.
        let mut inner = Inner {
            raw,
            stack: StackSizes::default(),
            groups_stack: GroupStack::default(),
            log: log.text(),
            slots: Mutex::default(),
            _groups: groups.to_vec(),
            context: context.clone(),
        };
        let stacks = groups.iter().map(|group| group.stack(raw)).collect::<Result<Vec<_>, _>>()?;
        inner.groups_stack = stacks.into_iter().collect();
        inner.stack = link.stack.unwrap_or_else(|| {
            let programs = stack::compute(inner.groups_stack, link.depths);
            let reserve = stack::traversal_reserve(context.limits().rt_core_version, link.max_graph_depth);
            StackSizes { continuation: programs.continuation.saturating_add(reserve), ..programs }
        });
        inner.set_stack(link.max_graph_depth)?;
        Ok(Self(Arc::new(inner)))
    }

    /// The stack sizes that were set, in bytes.
    pub fn stack(&self) -> StackSizes {
        self.0.stack
    }

    /// The largest stack use of each program kind, in bytes.
    pub fn groups_stack(&self) -> GroupStack {
        self.0.groups_stack
    }

    /// What the linker wrote. Empty when there is nothing to say.
    pub fn log(&self) -> &str {
        &self.0.log
    }

    /// The context it belongs to.
    pub fn context(&self) -> &Context {
        &self.0.context
    }

    pub(super) fn raw(&self) -> sys::OptixPipeline {
        self.0.raw
    }

    pub(super) fn slots(&self) -> &Mutex<Vec<Slot>> {
        &self.0.slots
    }
}

impl Inner {
    fn set_stack(&self, max_graph_depth: u32) -> Result<(), Error> {
        let StackSizes { direct_from_traversal, direct_from_state, continuation } = self.stack;
        // SAFETY: the pipeline is live and not yet launched.
        let result = unsafe {
            let table = self.context.table();
            table.pipeline_set_stack_size(
                self.raw,
                direct_from_traversal,
                direct_from_state,
                continuation,
                max_graph_depth,
            )
        };
        self.context.check("optixPipelineSetStackSize", result)
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        if let Ok(_current) = self.context.enter() {
            // Launches hold the pipeline and wait when dropped, but one that failed half-way may have left work behind.
            let _ = self.context.synchronize();
            // SAFETY: made by this context, destroyed here only, and no launch runs.
            let _ = unsafe { self.context.table().pipeline_destroy(self.raw) };
        }
    }
}

impl LinkOptions {
    fn check(&self, context: &Context, options: &PipelineOptions) -> Result<(), Error> {
        const WHAT: &str = "a pipeline";
        let (trace, max_trace) = (self.depths.trace, context.limits().max_trace_depth);
        if trace > max_trace {
            let problem = format!("trace depth {trace}, more than {max_trace}");
            return Err(Error::invalid(WHAT, problem, "turn recursion into a loop in the ray-generation program"));
        }
        let limit = options.graph.max_depth().unwrap_or(context.limits().max_graph_depth);
        if self.max_graph_depth == 0 || self.max_graph_depth > limit {
            let problem = format!("traversable graph depth {}, not within 1 to {limit}", self.max_graph_depth);
            return Err(Error::invalid(
                WHAT,
                problem,
                "flatten the graph, or allow deeper graphs in the pipeline options",
            ));
        }
        Ok(())
    }
}

fn check_groups(context: &Context, groups: &[ProgramGroup], options: &PipelineOptions) -> Result<(), Error> {
    for group in groups {
        context.owns("a pipeline", group.context())?;
        if let Some(module) = group.modules().iter().find(|module| module.pipeline_options() != options) {
            let problem =
                format!("a module was compiled with {:?}, the pipeline has {options:?}", module.pipeline_options());
            return Err(Error::invalid(
                "a pipeline",
                problem,
                "compile all modules of a pipeline with the same pipeline options (guide 6.3)",
            ));
        }
    }
    Ok(())
}
