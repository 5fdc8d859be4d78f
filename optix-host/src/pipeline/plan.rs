//! The specialisation of a pipeline type to a scene: everything that neither needs is left out.

use super::depth::{Depths, Reached, needed_entries, reached_entries};
use super::{BoundValue, Explanation, Note, ptx};
use crate::scene::SceneState;
use crate::{Error, Result};
use core::fmt;
use optix_device_rs::host::{GeometryKind, PipelineDescription};
use std::collections::BTreeSet;

/// Which traversable graphs rays meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Graph {
    SingleGas,
    SingleLevelInstancing,
    Any,
}

impl Graph {
    fn of_depth(depth: u32) -> Self {
        match depth {
            0 => Self::SingleGas,
            1 => Self::SingleLevelInstancing,
            _ => Self::Any,
        }
    }

    /// Whether a root with so many levels of instances may be traced against.
    pub fn allows(self, depth: u32) -> bool {
        self == Self::Any || self == Self::of_depth(depth)
    }
}

impl fmt::Display for Graph {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::SingleGas => "a single GAS",
            Self::SingleLevelInstancing => "one level of instances",
            Self::Any => "any graph",
        })
    }
}

/// Which exceptions are raised (guide 13.14).
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

/// A pipeline type specialised to a scene.
#[derive(Debug)]
pub(crate) struct Plan {
    pub description: PipelineDescription,
    pub kinds: Vec<GeometryKind>,
    pub graph: Graph,
    /// Levels of the graph, the GAS included.
    pub graph_depth: u32,
    pub attribute_words: u32,
    pub depths: Depths,
    pub exceptions: Exceptions,
    pub bound: Vec<BoundValue>,
    /// The text with only the entries that the scene needs.
    pub ptx: Option<String>,
    notes: Vec<Note>,
}

impl Plan {
    pub fn new(
        description: PipelineDescription,
        scene: &SceneState,
        ptx: Option<&str>,
        bound: Vec<BoundValue>,
    ) -> Result<Self> {
        let mut notes = Vec::new();
        let mut note = |what, choice: String, reason: String| notes.push(Note { what, choice, reason });

        let kinds = scene.usage.kinds.clone();
        let names: Vec<_> = kinds.iter().map(|k| format!("{k:?}").to_lowercase()).collect();
        note("primitive types", names.join(", "), "the kinds of geometry in the scene's structures".into());

        let depth = scene.usage.depths.iter().copied().max().unwrap_or(0);
        let graph = Graph::of_depth(depth);
        note("traversable graph", graph.to_string(), format!("{depth} levels of instances in the scene"));
        note("motion", "off".into(), "nothing in the scene moves".into());

        let used: BTreeSet<usize> = scene.slots.iter().map(|&(_, group)| group as usize).collect();
        let groups = || used.iter().map(|&g| &description.hitgroups[g]);
        let widest = groups().max_by_key(|g| g.attribute_words);
        // The driver takes 2 at the least.
        let attribute_words = widest.map_or(0, |g| g.attribute_words as u32).max(2);
        note(
            "attribute words",
            attribute_words.to_string(),
            widest.map_or("no hit groups".into(), |g| format!("the most of any hit group in use, {}", g.record.name)),
        );
        let left_out: Vec<_> = (0..description.hitgroups.len())
            .filter(|g| !used.contains(g))
            .map(|g| description.hitgroups[g].record.name)
            .collect();
        note(
            "hit groups",
            format!("{} of {}", used.len(), description.hitgroups.len()),
            if left_out.is_empty() {
                "the scene uses every material".into()
            } else {
                format!("left out, since no geometry has the material: {}", left_out.join(", "))
            },
        );
        let without: Vec<_> =
            groups().filter(|g| g.rays.iter().all(|r| r.anyhit.is_none())).map(|g| g.record.name).collect();
        if !without.is_empty() {
            note(
                "any-hit",
                format!("disabled on {}", without.join(", ")),
                "their hit groups have no any-hit program".into(),
            );
        }
        for ray in description.rays {
            let (words, memory_words) = (ray.payload.semantics.len(), ray.payload.memory_words);
            let reason = match memory_words {
                0 => "its fields; each word lives only between the programs that write and read it".into(),
                _ => format!("the address of its {memory_words} words in the caller's memory, as its `transport` says"),
            };
            note("payload words", format!("{words} of {}", ray.payload.name), reason);
        }

        if let Some(text) = ptx {
            check_layout(&description, text)?;
        }
        let callables: BTreeSet<usize> = scene.callables.iter().map(|callable| callable.program).collect();
        let entries = needed_entries(&description, &used, &callables);
        let depths = Depths::new(&description, &entries, ptx, &mut note)?;
        if !description.callables.is_empty() {
            let unused = (0..description.callables.len()).filter(|index| !callables.contains(index));
            let unused: Vec<_> = unused.map(|index| description.callables[index].entry.function).collect();
            note(
                "callables",
                format!("{} of {}", callables.len(), description.callables.len()),
                if unused.is_empty() {
                    "the scene has records of all".into()
                } else {
                    format!("left out, since the scene has no record of them: {}", unused.join(", "))
                },
            );
        }
        let (exceptions, why) = exceptions(&description, &entries, &depths, ptx);
        note("exceptions", exceptions.to_string(), why);

        for value in &bound {
            note("bound value", format!("{} = {}", value.field.name, value.value()), "bound by the host".into());
        }

        let ptx = ptx.map(|text| {
            let total = ptx::entries(text).len();
            let kept = ptx::without_entries(text, |name| entries.iter().any(|e| e.name == name));
            note(
                "programs compiled",
                format!("{} of {total}", entries.len()),
                "those that this pipeline and the scene's materials reach".into(),
            );
            kept
        });

        Ok(Self {
            description,
            kinds,
            graph,
            graph_depth: depth + 1,
            attribute_words,
            depths,
            exceptions,
            bound,
            ptx,
            notes,
        })
    }

    pub fn explanation(&self) -> Explanation {
        Explanation { pipeline: self.description.name, notes: self.notes.clone(), device: Vec::new() }
    }
}

/// Whether the PTX reads the launch parameters where this host writes them.
fn check_layout(description: &PipelineDescription, text: &str) -> Result<()> {
    let params = &description.params;
    match ptx::layout_fingerprint(text, params.symbol) {
        Some(fingerprint) if fingerprint == params.fingerprint => Ok(()),
        found => Err(Error::Pipeline {
            pipeline: description.name,
            what: format!(
                "the PTX is of another build than this host: {} of launch parameters `{}`; build both from the same source",
                if found.is_some() { "it has another layout" } else { "it has no layout" },
                params.name
            ),
        }),
    }
}

/// Which exceptions are raised, and why.
fn exceptions(
    description: &PipelineDescription,
    entries: &[Reached],
    depths: &Depths,
    ptx: Option<&str>,
) -> (Exceptions, String) {
    let declared = description.exceptions;
    if !declared.are_declared() {
        return (Exceptions::default(), "the pipeline declares none".into());
    }
    let throws = |text| reached_entries(entries, text).any(|entry| entry.text.contains("_optix_throw_exception"));
    let user = declared.throws.is_some() && ptx.is_none_or(throws);
    let exceptions = Exceptions { stack_overflow: true, trace_depth: depths.trace_is_a_promise, user };
    let mut reasons = Vec::new();
    if !depths.trace_is_a_promise {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn graphs_by_depth() {
        assert!(Graph::of_depth(1).allows(1) && !Graph::of_depth(1).allows(0));
        assert!(Graph::of_depth(3).allows(0) && Graph::of_depth(3).allows(2));
    }
}
