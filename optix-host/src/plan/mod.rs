//! The specialisation of a pipeline type to a scene: everything that neither needs is left out.

mod bind;
mod depth;
mod explain;

pub(crate) use bind::BoundValue;
pub(crate) use depth::Depths;
pub use explain::{Explanation, Note};

use crate::error::{LayoutDifference, PipelineError, ReferenceError};
use crate::scene::SceneState;
use crate::{Error, Result};
use core::fmt;
use depth::{Reached, needed_entries};
use optix_device_rs::host::{GeometryKind, PipelineDescription};
use optix_device_rs::layout::Crossing;
use optix_ptx::Module;
use std::collections::BTreeSet;
use std::sync::atomic::Ordering::Relaxed;

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

    /// For messages.
    fn words(self) -> &'static str {
        match self {
            Self::SingleGas => "a single GAS",
            Self::SingleLevelInstancing => "one level of instances",
            Self::Any => "any graph",
        }
    }

    /// Of a scene with so many levels of instances, where the `world()` of structures with the levels in `taken` (bit `n`: n levels)
    /// was taken. With the reason.
    fn of_roots(depth: u32, taken: u32) -> (Self, String) {
        match taken & !(1 << depth) {
            0 => (Self::of_depth(depth), format!("{depth} levels of instances in the scene")),
            others => {
                let least = others.trailing_zeros();
                let reason = format!("rays are traced against structures with {least} to {depth} levels of instances");
                (Self::Any, reason)
            }
        }
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
        let (graph, reason) = Graph::of_roots(depth, scene.usage.roots.load(Relaxed));
        note("traversable graph", graph.words().into(), reason);
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

        let plain = ptx.map(optix_ptx::plain);
        let module = plain.as_deref().map(Module::read);
        if let Some(module) = &module {
            check_layouts(&description, module)?;
        }
        let callables: BTreeSet<usize> = scene.callables.iter().map(|callable| callable.program).collect();
        let entries = needed_entries(&description, &used, &callables);
        let depths = Depths::new(&description, &entries, module.as_ref(), &mut note)?;
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
        let (exceptions, why) = exceptions(&description, &entries, &depths, module.as_ref());
        note("exceptions", exceptions.to_string(), why);

        for value in &bound {
            note("bound value", format!("{} = {}", value.field.name, value.value()), "bound by the host".into());
        }

        let ptx = ptx.zip(module).map(|(text, module)| {
            let total = module.entries().count();
            let kept = without_entries(text, &module, |name| entries.iter().any(|e| e.name == name));
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

    /// Whether a root with so many levels of instances may be traced against; why not.
    pub fn allows(&self, levels: u32) -> Result<(), ReferenceError> {
        let planned = self.graph_depth - 1;
        match self.graph {
            graph if levels > planned => Err(ReferenceError::GraphTooDeep { levels, planned, graph: graph.words() }),
            Graph::SingleLevelInstancing if levels == 0 => Err(ReferenceError::GasAlone),
            _ => Ok(()),
        }
    }

    pub fn explanation(&self) -> Explanation {
        Explanation { pipeline: self.description.name, notes: self.notes.clone(), device: Vec::new() }
    }
}

/// What the names of the device functions that throw begin with.
const THROW: &str = "_optix_throw_exception_";

/// Whether all that crosses between host and device is laid out in the PTX as on this host.
fn check_layouts(description: &PipelineDescription, module: &Module<'_>) -> Result<()> {
    let here = description.crossings;
    let there = module.variables.iter().find(|variable| variable.name == description.layouts);
    let error = match there.map(|variable| variable.numbers()) {
        None => PipelineError::NoLayouts { table: description.layouts },
        Some(numbers) if numbers.len() != 2 * here.len() => {
            PipelineError::CrossingCount { ptx: numbers.len() / 2, host: here.len() }
        }
        Some(numbers) => {
            let (there, _) = numbers.as_chunks();
            let pairs = here.iter().zip(there);
            let different: Vec<_> = pairs.filter_map(|(here, there)| difference(here, *there)).collect();
            if different.is_empty() {
                return Ok(());
            }
            PipelineError::Layouts(different)
        }
    };
    Err(Error::Pipeline { pipeline: description.name, error })
}

/// In what a type differs from the same type of the PTX, of which its table says size and layout; none if in nothing.
fn difference(here: &Crossing, [ptx, layout_there]: [u64; 2]) -> Option<LayoutDifference> {
    let Crossing { what, name, size, layout } = *here;
    let host = size as u64;
    let same = ptx == host && layout_there == layout.get();
    (!same).then(|| LayoutDifference { what, name, ptx, host, unit: here.unit() })
}

/// The text of a module without the entries that `keep` says no to.
fn without_entries(text: &str, module: &Module<'_>, keep: impl Fn(&str) -> bool) -> String {
    let mut result = String::with_capacity(text.len());
    let mut at = 0;
    for entry in module.entries().filter(|entry| !keep(entry.name)) {
        result.push_str(&text[at..entry.range.start]);
        at = entry.range.end;
    }
    result.push_str(&text[at..]);
    result
}

/// Which exceptions are raised, and why.
fn exceptions(
    description: &PipelineDescription,
    entries: &[Reached],
    depths: &Depths,
    module: Option<&Module<'_>>,
) -> (Exceptions, String) {
    let declared = description.exceptions;
    if !declared.are_declared() {
        return (Exceptions::default(), "the pipeline declares none".into());
    }
    let throws = |module| entries.iter().any(|entry| entry.calls(module, |name| name.starts_with(THROW)));
    let user = declared.throws.is_some() && module.is_none_or(throws);
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
    use optix_device_rs::host::{ExceptionsDescription, ParamsDescription};
    use optix_device_rs::layout::Layout;

    const PTX: &str = "\
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

    #[test]
    fn entries_are_cut_at_their_own_brace() {
        let plain = optix_ptx::plain(PTX);
        let module = Module::read(&plain);
        let rest = without_entries(PTX, &module, |name| name != "__raygen__a");
        assert!(rest.contains("p[16]") && rest.contains("q = 12;\n\n\t// .globl\t__miss__b"), "{rest}");
        let rest = without_entries(PTX, &module, |name| !name.starts_with("__direct"));
        assert!(rest.trim_end().ends_with("helper_param_0\n)\n;"), "{rest}");
        assert_eq!(without_entries(PTX, &module, |_| true), PTX);
    }

    #[test]
    fn layouts_are_compared_type_by_type() {
        let record = |name, size, ty| Crossing::new("record", name, size, Layout::of(ty));
        const HERE: [Crossing; 2] = [
            Crossing::new("launch parameters", "Frame", 32, Layout::of("f")),
            Crossing::new("attributes", "Hit", 3, Layout::of("h")),
        ];
        let description = PipelineDescription { crossings: &HERE, layouts: "layouts", ..plan().description };
        let with = |there: &[Crossing]| {
            let numbers = there.iter().flat_map(|crossing| [crossing.size as i64, crossing.layout.get() as i64]);
            let numbers: Vec<_> = numbers.map(|number| number.to_string()).collect();
            let text =
                format!("{PTX}.visible .global .align 8 .b64 layouts[{}] = {{{}}};", numbers.len(), numbers.join(", "));
            check_layouts(&description, &Module::read(&text)).err().map(|error| error.to_string())
        };
        assert_eq!(with(&HERE), None);
        let says = |there: &[Crossing], parts: &[&str]| {
            let error = with(there).expect("another layout");
            assert!(parts.iter().all(|part| error.contains(part)), "{error}");
        };
        let [frame, hit] = HERE;
        says(&[frame, Crossing { size: 7, ..hit }], &["pipeline Test", "attributes `Hit`: 7 words there, 3 here"]);
        let other = Crossing { layout: Layout::of("g"), ..frame };
        says(&[other, hit], &["launch parameters `Frame`: 32 bytes in both, but with other fields"]);
        says(
            &[record("R", 4, "r"), record("S", 4, "r")],
            &["`Frame`: 4 bytes there, 32 here; attributes `Hit`: 4 words"],
        );
        says(&[frame], &["1 types cross between host and device there, and 2 here"]);
        let error = check_layouts(&description, &Module::read(PTX)).expect_err("no layouts").to_string();
        assert!(error.contains("does not have the pipeline's layouts, `layouts`"), "{error}");
    }

    #[test]
    fn graphs_by_depth() {
        assert_eq!(Graph::of_roots(1, 0b10).0, Graph::SingleLevelInstancing);
        assert_eq!(Graph::of_roots(1, 0).0, Graph::SingleLevelInstancing);
        assert_eq!(Graph::of_roots(1, 0b11).0, Graph::Any, "the GAS is traced against, too");
        assert_eq!(Graph::of_roots(0, 0b1).0, Graph::SingleGas);
        for planned in 0..4 {
            let plan = Plan { graph: Graph::of_depth(planned), graph_depth: planned + 1, ..plan() };
            for depth in 0..6 {
                let refused = plan.allows(depth).err();
                assert_eq!(refused.is_some(), depth > planned || planned == 1 && depth == 0, "{depth} in {planned}");
                if let Some(why) = refused {
                    assert_eq!(matches!(why, ReferenceError::GasAlone), depth == 0, "{why}");
                    assert!(why.remedy().contains(if depth == 0 {
                        "put the GAS into one"
                    } else {
                        "after the acceleration structures"
                    }));
                }
            }
        }
    }

    /// Of no programs.
    fn plan() -> Plan {
        let params = ParamsDescription { name: "()", symbol: "", size: 0, align: 1, fields: &[] };
        Plan {
            description: PipelineDescription {
                name: "Test",
                params,
                raygen: &[],
                rays: &[],
                hitgroups: &[],
                callables: &[],
                exceptions: ExceptionsDescription { throws: None, variants: &[], program: None },
                trace_depth: None,
                callable_depth: None,
                crossings: &[],
                layouts: "",
            },
            kinds: Vec::new(),
            graph: Graph::Any,
            graph_depth: 1,
            attribute_words: 2,
            depths: Depths {
                trace: 0,
                trace_is_a_promise: false,
                continuation: 0,
                direct_from_traversal: 0,
                direct_from_state: 0,
            },
            exceptions: Exceptions::default(),
            bound: Vec::new(),
            ptx: None,
            notes: Vec::new(),
        }
    }
}
