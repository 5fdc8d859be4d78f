//! The specialisation of a pipeline type to a scene: everything that neither needs is left out.

use super::{BoundValue, Explanation, Note, ptx};
use crate::scene::SceneState;
use crate::{Error, Result};
use core::fmt;
use optix_device_rs::host::{GeometryKind, PipelineDescription};
use std::collections::{BTreeMap, BTreeSet};

/// Deepest nesting of trace calls (guide 12).
const MAX_TRACE_DEPTH: u32 = 31;

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

/// A pipeline type specialised to a scene.
#[derive(Debug)]
pub(crate) struct Plan {
    pub description: PipelineDescription,
    pub kinds: Vec<GeometryKind>,
    pub graph: Graph,
    /// Levels of the graph, the GAS included.
    pub graph_depth: u32,
    pub attribute_words: u32,
    pub trace_depth: u32,
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
        let entries = needed_entries(&description, &used);
        let (trace_depth, why) = trace_depth(&description, &entries, ptx)?;
        note("trace depth", trace_depth.to_string(), why);

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

        Ok(Self { description, kinds, graph, graph_depth: depth + 1, attribute_words, trace_depth, bound, ptx, notes })
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

/// A program that a launch can reach, and for which ray type it runs (none for ray generation).
struct Reached {
    name: &'static str,
    ray: Option<usize>,
}

fn needed_entries(description: &PipelineDescription, used: &BTreeSet<usize>) -> Vec<Reached> {
    let mut entries: Vec<Reached> = Vec::new();
    let mut add = |name, ray| {
        if !entries.iter().any(|e| e.name == name && e.ray == ray) {
            entries.push(Reached { name, ray });
        }
    };
    for raygen in description.raygen {
        add(raygen.entry.name, None);
    }
    for (ray, of) in description.rays.iter().enumerate() {
        if let Some(miss) = of.miss {
            add(miss.entry.name, Some(ray));
        }
        for &group in used {
            let programs = description.hitgroups[group].rays[ray];
            for entry in [programs.closesthit, programs.anyhit, programs.intersection].into_iter().flatten() {
                add(entry.name, Some(ray));
            }
        }
    }
    entries
}

/// How deep trace calls nest: the longest path from ray generation over ray types, where a ray type leads to those that its
/// programs trace.
fn trace_depth(description: &PipelineDescription, entries: &[Reached], ptx: Option<&str>) -> Result<(u32, String)> {
    let error = |what: String| Error::Pipeline { pipeline: description.name, what };
    if let Some(depth) = description.trace_depth {
        return match depth {
            0..=MAX_TRACE_DEPTH => Ok((depth, "stated in the pipeline's declaration".into())),
            _ => Err(error(format!("trace_depth {depth} is more than {MAX_TRACE_DEPTH} (guide 12)"))),
        };
    }
    let Some(text) = ptx else {
        return Ok((MAX_TRACE_DEPTH, "the most there is: without PTX it is not known which programs trace".into()));
    };
    let by_name: BTreeMap<_, _> = ptx::entries(text).into_iter().map(|e| (e.name, e)).collect();
    let rays = description.rays.len();
    let mut leads_to = vec![BTreeSet::new(); rays];
    let mut roots = BTreeSet::new();
    for reached in entries {
        let entry = by_name.get(reached.name).ok_or_else(|| {
            error(format!(
                "the PTX has no entry {}: it is of another build or crate than the host's pipeline",
                reached.name
            ))
        })?;
        let types = ptx::traced_types(entry).ok_or_else(|| {
            error(format!(
                "the payload type of a trace call in {} is not a constant, so the trace depth is not known: \
                 state `trace_depth: N` in `pipeline!`",
                reached.name
            ))
        })?;
        let traced = types.into_iter().map(|mask| mask.trailing_zeros() as usize).filter(|&r| r < rays);
        match reached.ray {
            None => roots.extend(traced),
            Some(ray) => leads_to[ray].extend(traced),
        }
    }
    match longest(&leads_to, &roots, &mut vec![false; rays]) {
        Some(depth) => Ok((depth, "the longest chain of trace calls in the compiled programs".into())),
        None => Err(error(
            "its programs trace rays recursively, so nothing bounds the trace depth: state `trace_depth: N` in `pipeline!`"
                .into(),
        )),
    }
}

/// The longest path from any of `from`; `None` if there is a cycle.
fn longest(leads_to: &[BTreeSet<usize>], from: &BTreeSet<usize>, on_path: &mut Vec<bool>) -> Option<u32> {
    let mut depth = 0;
    for &ray in from {
        if on_path[ray] {
            return None;
        }
        on_path[ray] = true;
        depth = depth.max(1 + longest(leads_to, &leads_to[ray], on_path)?);
        on_path[ray] = false;
    }
    Some(depth)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn longest_chain_of_ray_types() {
        let set = |items: &[usize]| items.iter().copied().collect::<BTreeSet<_>>();
        let path = |edges: &[&[usize]], roots: &[usize]| {
            let edges: Vec<_> = edges.iter().map(|e| set(e)).collect();
            longest(&edges, &set(roots), &mut vec![false; edges.len()])
        };
        assert_eq!(path(&[&[1], &[]], &[0]), Some(2));
        assert_eq!(path(&[&[], &[]], &[0, 1]), Some(1));
        assert_eq!(path(&[&[1], &[0]], &[0]), None);
        assert_eq!(path(&[&[1], &[1]], &[]), Some(0));
    }

    #[test]
    fn graphs_by_depth() {
        assert!(Graph::of_depth(1).allows(1) && !Graph::of_depth(1).allows(0));
        assert!(Graph::of_depth(3).allows(0) && Graph::of_depth(3).allows(2));
    }
}
