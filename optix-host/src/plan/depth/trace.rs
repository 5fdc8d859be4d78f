//! How deep trace calls nest (guide 6.7).

use super::super::programs::Stage;
use super::nesting::{Nesting, NestingError, nesting};
use super::program::{CONTINUATION, Program};
use crate::error::PipelineError;
use crate::limits::MAX_TRACE_DEPTH;
use optix_device_rs::host::PipelineDescription;
use std::collections::{BTreeMap, BTreeSet};

/// How deep trace calls nest, whether that is only a promise, and why: the longest path from ray generation over ray types,
/// where a ray type leads to those that its programs trace, and a call of a continuation callable to those that any of them
/// traces.
pub(super) fn trace_depth(
    description: &PipelineDescription,
    programs: Option<&[Program<'_, '_>]>,
) -> Result<(u32, bool, String), PipelineError> {
    let stated = description.trace_depth;
    if let Some(depth) = stated.filter(|&depth| depth > MAX_TRACE_DEPTH) {
        return Err(PipelineError::TraceDepthLimit { stated: depth });
    }
    let Some(programs) = programs else {
        return Ok(match stated {
            Some(depth) => (depth, true, "stated in the pipeline's declaration".into()),
            None => {
                (MAX_TRACE_DEPTH, true, "the most there is: without PTX it is not known which programs trace".into())
            }
        });
    };
    let traces = match (Traces::of(description, programs), stated) {
        (Ok(traces), _) => traces,
        (Err(program), Some(depth)) => {
            let why = format!("stated in the pipeline's declaration; which rays `{program}` traces is not known");
            return Ok((depth, true, why));
        }
        (Err(program), None) => {
            return Err(PipelineError::UnknownTraceDepth { program });
        }
    };
    let ray = |ray: usize| description.rays[ray].payload.name;
    match nesting(&traces.leads_to, &traces.roots, stated) {
        Ok(Nesting::Known(depth)) => Ok(match stated {
            Some(stated) if stated > depth => (
                stated,
                false,
                format!("stated in the pipeline's declaration; the compiled programs trace {depth} deep"),
            ),
            _ => (depth, false, "the longest chain of trace calls in the compiled programs".into()),
        }),
        Ok(Nesting::Stated(depth)) => {
            Ok((depth, true, "stated in the pipeline's declaration: the programs trace rays recursively".into()))
        }
        Err(NestingError::Endless(node)) => Err(PipelineError::EndlessTraces { ray: ray(node) }),
        Err(NestingError::Deeper(chain, stated)) => {
            let from = core::iter::once(None).chain(chain.iter().copied().map(Some));
            let chain = from.zip(&chain).map(|(from, &to)| (traces.who[&(from, to)], ray(to))).collect();
            Err(PipelineError::TraceDepth { stated, chain })
        }
    }
}

/// Which ray types lead to which.
struct Traces {
    /// Those of ray generation.
    roots: BTreeSet<usize>,
    leads_to: Vec<BTreeSet<usize>>,
    /// The first program that traces a ray type in the programs of another, or in ray generation.
    who: BTreeMap<(Option<usize>, usize), &'static str>,
}

impl Traces {
    /// The error is a program of which it can't be said what it traces.
    fn of(description: &PipelineDescription, programs: &[Program<'_, '_>]) -> Result<Self, &'static str> {
        let rays = description.rays.len();
        let traced = |program: &Program<'_, '_>| -> Result<Vec<(usize, &'static str)>, &'static str> {
            let function = program.reached.function;
            let traces = program.traces.as_ref().ok_or(function)?;
            Ok(traces.iter().copied().filter(|&ray| ray < rays).map(|ray| (ray, function)).collect())
        };
        let mut by_callables = Vec::new();
        for program in programs.iter().filter(|program| program.reached.stage == Stage::Continuation) {
            by_callables.extend(traced(program)?);
        }
        let mut all = Self { roots: BTreeSet::new(), leads_to: vec![BTreeSet::new(); rays], who: BTreeMap::new() };
        for program in programs {
            let (from, to) = match program.reached.stage {
                Stage::RayGen => (None, &mut all.roots),
                Stage::Shading(ray) => (Some(ray), &mut all.leads_to[ray]),
                // Those trace nothing, or count where they are called.
                _ => continue,
            };
            let calls = program.calls.contains(CONTINUATION.call);
            for (ray, function) in traced(program)?.into_iter().chain(by_callables.iter().copied().filter(|_| calls)) {
                to.insert(ray);
                all.who.entry((from, ray)).or_insert(function);
            }
        }
        Ok(all)
    }
}
