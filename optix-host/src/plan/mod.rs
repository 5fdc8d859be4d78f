//! Specialises a pipeline type to a scene: everything that the scene does not need is left out.

mod bind;
mod depth;
mod exceptions;
mod explain;
mod graph;
mod layouts;
mod programs;

pub(crate) use bind::BoundValue;
pub(crate) use depth::Depths;
pub(crate) use exceptions::Exceptions;
pub use explain::{Explanation, Note};
pub(crate) use graph::Graph;

use crate::Result;
use crate::error::ReferenceError;
use crate::features::Features;
use explain::Notes;
use layouts::check_layouts;
use optix_device_rs::host::{HitGroupDescription, PipelineDescription, PrimitiveType};
use optix_ptx::Module;
use programs::{reached_programs, without_entries};

/// A pipeline type specialised to a scene.
#[derive(Debug)]
pub(crate) struct Plan {
    pub description: PipelineDescription,
    pub primitives: Vec<PrimitiveType>,
    pub motion: bool,
    pub graph: Graph,
    /// Levels of the graph, the GAS included.
    pub graph_depth: u32,
    pub attribute_words: u32,
    pub depths: Depths,
    pub exceptions: Exceptions,
    pub bound: Vec<BoundValue>,
    /// The text of the PTX, with only the entries that the scene needs.
    pub ptx: Option<String>,
    notes: Notes,
}

impl Plan {
    pub fn new(
        description: PipelineDescription,
        features: &Features,
        ptx: Option<&str>,
        bound: Vec<BoundValue>,
    ) -> Result<Self> {
        let mut notes = Notes::default();
        note_primitives(features, &mut notes);
        let (graph, reason) = Graph::of(features);
        notes.add("traversable graph", graph.words(), reason);
        note_motion(features, &mut notes);
        let groups: Vec<_> = features.hit_groups.iter().map(|&group| &description.hitgroups[group]).collect();
        let attribute_words = attribute_words(&groups, &mut notes);
        note_hit_groups(&description, features, &groups, &mut notes);
        note_payloads(&description, &mut notes);

        let plain = ptx.map(optix_ptx::plain);
        let module = plain.as_deref().map(Module::read);
        if let Some(module) = &module {
            check_layouts(&description, module)?;
        }
        let reached = reached_programs(&description, features);
        let depths = Depths::new(&description, &reached, module.as_ref(), &mut notes)?;
        note_callables(&description, features, &mut notes);
        let (exceptions, reason) = Exceptions::of(&description, &reached, &depths, module.as_ref());
        notes.add("exceptions", exceptions.to_string(), reason);
        for value in &bound {
            notes.add("bound value", format!("{} = {}", value.field.name, value.value()), "bound by the host");
        }
        let ptx = ptx.zip(module).map(|(text, module)| {
            let total = module.entries().count();
            notes.add(
                "programs compiled",
                format!("{} of {total}", reached.len()),
                "those that this pipeline and the scene's materials reach",
            );
            without_entries(text, &module, |name| reached.iter().any(|program| program.name == name))
        });

        Ok(Self {
            description,
            primitives: features.primitives.clone(),
            motion: features.motion,
            graph,
            graph_depth: features.instance_levels + 1,
            attribute_words,
            depths,
            exceptions,
            bound,
            ptx,
            notes,
        })
    }

    /// Checks whether rays may be traced against a structure with so many levels of instances.
    pub fn allows(&self, levels: u32) -> Result<(), ReferenceError> {
        self.graph.allows(levels, self.graph_depth - 1)
    }

    pub fn explanation(&self) -> Explanation {
        self.notes.explanation(self.description.name)
    }
}

fn note_primitives(features: &Features, notes: &mut Notes) {
    let names: Vec<_> = features.primitives.iter().map(|kind| format!("{kind:?}").to_lowercase()).collect();
    notes.add("primitive types", names.join(", "), "the kinds of geometry in the scene's structures");
}

fn note_motion(features: &Features, notes: &mut Notes) {
    match features.motion {
        true => notes.add("motion", "on", "geometry of the scene has motion keys"),
        false => notes.add("motion", "off", "nothing in the scene moves"),
    }
}

/// The attribute words of the hit groups in use. The driver takes 2 at the least.
fn attribute_words(groups: &[&HitGroupDescription], notes: &mut Notes) -> u32 {
    let widest = groups.iter().max_by_key(|group| group.attribute_words);
    let words = widest.map_or(0, |group| group.attribute_words as u32).max(2);
    let reason = match widest {
        None => "no hit groups".into(),
        Some(group) => format!("the most of any hit group in use, {}", group.record.name),
    };
    notes.add("attribute words", words.to_string(), reason);
    words
}

fn note_hit_groups(
    description: &PipelineDescription,
    features: &Features,
    groups: &[&HitGroupDescription],
    notes: &mut Notes,
) {
    let left_out = description.hitgroups.iter().enumerate().filter(|(group, _)| !features.hit_groups.contains(group));
    let left_out: Vec<_> = left_out.map(|(_, group)| group.record.name).collect();
    let reason = match left_out[..] {
        [] => "the scene uses every material".into(),
        _ => format!("left out, since no geometry has the material: {}", left_out.join(", ")),
    };
    notes.add("hit groups", format!("{} of {}", groups.len(), description.hitgroups.len()), reason);
    let without = groups.iter().filter(|group| group.rays.iter().all(|ray| ray.anyhit.is_none()));
    let without: Vec<_> = without.map(|group| group.record.name).collect();
    if !without.is_empty() {
        let choice = format!("disabled on {}", without.join(", "));
        notes.add("any-hit", choice, "their hit groups have no any-hit program");
    }
}

fn note_payloads(description: &PipelineDescription, notes: &mut Notes) {
    for ray in description.rays {
        let (words, memory_words) = (ray.payload.semantics.len(), ray.payload.memory_words);
        let reason = match memory_words {
            0 => "its fields; each word lives only between the programs that write and read it".into(),
            _ => format!("the address of its {memory_words} words in the caller's memory, as its `transport` says"),
        };
        notes.add("payload words", format!("{words} of {}", ray.payload.name), reason);
    }
}

fn note_callables(description: &PipelineDescription, features: &Features, notes: &mut Notes) {
    if description.callables.is_empty() {
        return;
    }
    let unused = description.callables.iter().enumerate().filter(|(index, _)| !features.callables.contains(index));
    let unused: Vec<_> = unused.map(|(_, callable)| callable.entry.function).collect();
    let reason = match unused[..] {
        [] => "the scene has records of all".into(),
        _ => format!("left out, since the scene has no record of them: {}", unused.join(", ")),
    };
    notes.add("callables", format!("{} of {}", features.callables.len(), description.callables.len()), reason);
}

#[cfg(test)]
mod tests {
    use optix_device_rs::host::{ExceptionsDescription, ParamsDescription, PipelineDescription};

    pub const PTX: &str = "\
.visible .const .align 8 .b8 p[16];
.visible .global .align 8 .b64 q = 12;
.visible .entry __raygen__a()
{
\t// begin inline asm }
\t{
\tcall (%r5), _optix_trace_typed_32, (4, %rd1, f0);
\t}
\tret;
}
\t// .globl\t__miss__b
.visible .entry __miss__b() { ret; }
.visible .func  (.param .b32 func_retval0) helper(
\t.param .b32 helper_param_0
)
;
.visible .func  (.param .align 4 .b8 func_retval0[12]) __direct_callable__c(
\t.param .b32 __direct_callable__c_param_0
)
{
\tret;
}
";

    /// A pipeline without programs.
    pub const EMPTY: PipelineDescription = PipelineDescription {
        name: "Test",
        params: ParamsDescription { name: "()", symbol: "", size: 0, align: 1, fields: &[] },
        raygen: &[],
        rays: &[],
        hitgroups: &[],
        callables: &[],
        exceptions: ExceptionsDescription { throws: None, variants: &[], program: None },
        trace_depth: None,
        callable_depth: None,
        crossings: &[],
        layouts: "",
    };
}
