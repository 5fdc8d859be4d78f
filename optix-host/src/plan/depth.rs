//! Which programs a launch reaches, and how deep their calls nest (guide 6.7, 6.8).

use crate::{Error, Result};
use optix_device_rs::host::PipelineDescription;
use optix_ptx::{Function, Module, Prototype};
use std::collections::BTreeSet;

/// Deepest nesting of trace calls (guide 12).
const MAX_TRACE_DEPTH: u32 = 31;
/// Deepest nesting of callables where neither the declaration nor the programs say one: as deep as `pipeline!` allows.
const MAX_CALLABLE_DEPTH: u32 = 31;

const TRACE: &str = "_optix_trace_typed_32";

/// One of the two kinds of callables.
struct CallableKind {
    name: &'static str,
    place: Place,
    /// What the PTX calls to get the address of one.
    call: &'static str,
}

const DIRECT: CallableKind = CallableKind { name: "direct", place: Place::Direct, call: "_optix_call_direct_callable" };
const CONTINUATION: CallableKind =
    CallableKind { name: "continuation", place: Place::Continuation, call: "_optix_call_continuation_callable" };

/// A program that a launch can reach.
pub(crate) struct Reached {
    pub name: &'static str,
    place: Place,
}

impl Reached {
    /// Whether the program, or what it calls, calls a device function that `is_it` says yes to.
    pub fn calls(&self, module: &Module<'_>, is_it: impl Fn(&str) -> bool) -> bool {
        module.reached(self.name).iter().flat_map(|function| function.calls()).any(|call| is_it(call.function))
    }
}

/// When it runs.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    RayGen,
    /// Closest-hit or miss, for a ray type.
    Shading(usize),
    /// Any-hit or intersection, for a ray type.
    Traversal(usize),
    Direct,
    Continuation,
    Exception,
}

/// The programs that this pipeline needs for the hit groups `groups` and the callables `callables`.
pub(crate) fn needed_entries(
    description: &PipelineDescription,
    groups: &BTreeSet<usize>,
    callables: &BTreeSet<usize>,
) -> Vec<Reached> {
    let mut entries: Vec<Reached> = Vec::new();
    let mut add = |name, place| {
        if !entries.iter().any(|e| e.name == name && e.place == place) {
            entries.push(Reached { name, place });
        }
    };
    for raygen in description.raygen {
        add(raygen.entry.name, Place::RayGen);
    }
    for (ray, of) in description.rays.iter().enumerate() {
        if let Some(miss) = of.miss {
            add(miss.entry.name, Place::Shading(ray));
        }
        for &group in groups {
            let programs = description.hitgroups[group].rays[ray];
            if let Some(entry) = programs.closesthit {
                add(entry.name, Place::Shading(ray));
            }
            for entry in [programs.anyhit, programs.intersection].into_iter().flatten() {
                add(entry.name, Place::Traversal(ray));
            }
        }
    }
    for callable in callables.iter().map(|&index| &description.callables[index]) {
        add(callable.entry.name, if callable.continuation { Place::Continuation } else { Place::Direct });
    }
    if let Some(program) = description.exceptions.program {
        add(program.entry.name, Place::Exception);
    }
    entries
}

/// How deep calls nest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Depths {
    /// Trace calls.
    pub trace: u32,
    /// Whether the trace depth is what the declaration says, and not what follows from the programs.
    pub trace_is_a_promise: bool,
    /// Continuation callables.
    pub continuation: u32,
    /// Direct callables below any-hit and intersection programs.
    pub direct_from_traversal: u32,
    /// Direct callables below other programs.
    pub direct_from_state: u32,
}

impl Depths {
    /// From what the declaration says, and from the programs in the PTX where it says nothing.
    pub fn new(
        description: &PipelineDescription,
        entries: &[Reached],
        module: Option<&Module<'_>>,
        note: &mut impl FnMut(&'static str, String, String),
    ) -> Result<Self> {
        let error = |what: String| Error::Pipeline { pipeline: description.name, what };
        let programs = module.map(|module| programs(entries, module).map_err(error)).transpose()?;
        let programs = programs.as_deref();
        let (trace, why) = trace(description, programs).map_err(error)?;
        note("trace depth", trace.to_string(), why);
        let mut depths = Self {
            trace,
            trace_is_a_promise: description.trace_depth.is_some() || programs.is_none(),
            continuation: 0,
            direct_from_traversal: 0,
            direct_from_state: 0,
        };
        if !description.callables.is_empty() {
            depths.add_callables(description, programs).map_err(error)?;
            let Self { continuation, direct_from_traversal, direct_from_state, .. } = depths;
            note(
                "callable depth",
                format!(
                    "{continuation} continuation, {direct_from_state} direct, {direct_from_traversal} during traversal"
                ),
                match (description.callable_depth, programs) {
                    (None, None) => "the most there is: without PTX it is not known which programs call",
                    (Some(_), None) => "stated in the pipeline's declaration",
                    (Some(_), Some(_)) => {
                        "the longest chain of calls in the compiled programs, or what the declaration states if that is less"
                    }
                    (None, Some(_)) => "the longest chain of calls in the compiled programs",
                }
                .into(),
            );
        }
        Ok(depths)
    }

    fn add_callables(
        &mut self,
        description: &PipelineDescription,
        programs: Option<&[Program<'_, '_>]>,
    ) -> Result<(), String> {
        let is_state = |place| matches!(place, Place::RayGen | Place::Shading(_) | Place::Continuation);
        let Some(programs) = programs else {
            let depth = description.callable_depth.unwrap_or(MAX_CALLABLE_DEPTH);
            (self.continuation, self.direct_from_traversal, self.direct_from_state) = (depth, depth, depth);
            return Ok(());
        };
        let depth = |kind: &CallableKind, from: fn(Place) -> bool| {
            nesting(programs, kind, from, description.callable_depth).map_err(|name| {
                let callable = description.callables.iter().find(|callable| callable.entry.name == name);
                format!(
                    "its {} callables call each other, and `{}` can come to be called inside of itself, so nothing bounds how \
                     deep: state `callable_depth: N` in `pipeline!`, the most callables that run one inside of the other",
                    kind.name,
                    callable.map_or(name, |callable| callable.entry.function)
                )
            })
        };
        self.continuation = depth(&CONTINUATION, is_state)?;
        self.direct_from_traversal = depth(&DIRECT, |place| matches!(place, Place::Traversal(_)))?;
        self.direct_from_state = depth(&DIRECT, is_state)?;
        Ok(())
    }

    /// The most callables that may run inside one another between two trace calls.
    pub fn callables(&self) -> u32 {
        self.continuation + self.direct_from_state.max(self.direct_from_traversal)
    }
}

/// A program and what it does, in functions that it calls too.
struct Program<'e, 'a> {
    reached: &'e Reached,
    /// The functions that it calls.
    calls: BTreeSet<&'a str>,
    /// The ray types that it traces; `None` where one is not a constant.
    traces: Option<BTreeSet<usize>>,
    /// What it takes and gives.
    prototype: Option<Prototype>,
    /// What the callables that it calls take and give; `None` where that can't be read.
    called: Option<Vec<Prototype>>,
}

fn programs<'e, 'a>(entries: &'e [Reached], module: &Module<'a>) -> Result<Vec<Program<'e, 'a>>, String> {
    let program = |reached: &'e Reached| {
        let functions = module.reached(reached.name);
        if functions.is_empty() {
            return Err(format!(
                "the PTX has no entry {}: it is of another build or crate than the host's pipeline",
                reached.name
            ));
        }
        let calls = functions.iter().flat_map(|function| function.calls()).map(|call| call.function).collect();
        let prototype = functions[0].prototype.clone();
        Ok(Program { reached, calls, traces: traced(&functions), prototype, called: called(&functions) })
    };
    entries.iter().map(program).collect()
}

/// The ray types that functions trace: the bits of `OptixPayloadTypeID`, which is the first argument of each trace call.
/// `None` where one is not a constant.
fn traced(functions: &[&Function<'_>]) -> Option<BTreeSet<usize>> {
    let calls = functions.iter().flat_map(|function| function.calls()).filter(|call| call.function == TRACE);
    calls.map(|call| Some((*call.values.first()?)?.trailing_zeros() as usize)).collect()
}

/// The prototypes by which functions call callables. `None` where one can't be read.
fn called(functions: &[&Function<'_>]) -> Option<Vec<Prototype>> {
    let is_callable = |name: &str| [&DIRECT, &CONTINUATION].iter().any(|kind| kind.call == name);
    let calls = functions.iter().flat_map(|function| function.calls()).filter(|call| is_callable(call.function));
    let prototypes =
        functions.iter().map(|function| function.called_prototypes()).collect::<Option<Vec<_>>>()?.concat();
    (prototypes.len() >= calls.count()).then_some(prototypes)
}

/// How deep callables of a kind nest below the programs that run at these places: the longest path over callables, where a
/// program leads to those that take and give what it calls with. Without an end to that it is what is stated; else the error is
/// the name of a callable that leads to itself.
fn nesting(
    programs: &[Program<'_, '_>],
    kind: &CallableKind,
    from: fn(Place) -> bool,
    stated: Option<u32>,
) -> Result<u32, &'static str> {
    let callables: Vec<_> = programs.iter().filter(|program| program.reached.place == kind.place).collect();
    let called = |program: &Program<'_, '_>| -> BTreeSet<usize> {
        // What can't be read may be any.
        let fits = |callable: &Program<'_, '_>| match (&callable.prototype, &program.called) {
            (Some(prototype), Some(called)) => called.contains(prototype),
            _ => true,
        };
        let all = if program.calls.contains(kind.call) { callables.len() } else { 0 };
        (0..all).filter(|&index| fits(callables[index])).collect()
    };
    let leads_to: Vec<_> = callables.iter().map(|callable| called(callable)).collect();
    let roots = programs.iter().filter(|program| from(program.reached.place)).flat_map(called).collect();
    match (longest(&leads_to, &roots, &mut vec![Visit::New; callables.len()]), stated) {
        (Ok(depth), stated) => Ok(stated.map_or(depth, |stated| stated.min(depth))),
        (Err(_), Some(stated)) => Ok(stated),
        (Err(callable), None) => Err(callables[callable].reached.name),
    }
}

/// How deep trace calls nest: the longest path from ray generation over ray types, where a ray type leads to those that its
/// programs trace, and a call of a continuation callable to those that any of them traces.
fn trace(description: &PipelineDescription, programs: Option<&[Program<'_, '_>]>) -> Result<(u32, String), String> {
    if let Some(depth) = description.trace_depth {
        return match depth {
            0..=MAX_TRACE_DEPTH => Ok((depth, "stated in the pipeline's declaration".into())),
            _ => Err(format!("trace_depth {depth} is more than {MAX_TRACE_DEPTH} (guide 12)")),
        };
    }
    let Some(programs) = programs else {
        return Ok((MAX_TRACE_DEPTH, "the most there is: without PTX it is not known which programs trace".into()));
    };
    let rays = description.rays.len();
    let traced = |program: &Program<'_, '_>| match &program.traces {
        Some(traces) => Ok(traces.iter().copied().filter(|&ray| ray < rays).collect::<BTreeSet<_>>()),
        None => Err(format!(
            "the payload type of a trace call in {} is not a constant, so the trace depth is not known: state \
             `trace_depth: N` in `pipeline!`",
            program.reached.name
        )),
    };
    let mut by_callables = BTreeSet::new();
    for program in programs.iter().filter(|program| program.reached.place == Place::Continuation) {
        by_callables.extend(traced(program)?);
    }
    let mut leads_to = vec![BTreeSet::new(); rays];
    let mut roots = BTreeSet::new();
    for program in programs {
        let to = match program.reached.place {
            Place::RayGen => &mut roots,
            Place::Shading(ray) => &mut leads_to[ray],
            // Those trace nothing, or count where they are called.
            _ => continue,
        };
        to.extend(traced(program)?);
        if program.calls.contains(CONTINUATION.call) {
            to.extend(&by_callables);
        }
    }
    match longest(&leads_to, &roots, &mut vec![Visit::New; rays]) {
        Ok(depth) => Ok((depth, "the longest chain of trace calls in the compiled programs".into())),
        Err(ray) => Err(format!(
            "its programs trace rays recursively, and a ray `{}` can lead to another, so nothing bounds the trace depth: state \
             `trace_depth: N` in `pipeline!`",
            description.rays[ray].payload.name
        )),
    }
}

/// What is known of a node.
#[derive(Clone, Copy)]
enum Visit {
    New,
    OnPath,
    /// The longest path from here.
    Done(u32),
}

/// The longest path from any of `from`; the error is a node that leads to itself.
fn longest(leads_to: &[BTreeSet<usize>], from: &BTreeSet<usize>, visits: &mut [Visit]) -> Result<u32, usize> {
    let mut depth = 0;
    for &node in from {
        let below = match visits[node] {
            Visit::OnPath => return Err(node),
            Visit::Done(below) => below,
            Visit::New => {
                visits[node] = Visit::OnPath;
                let below = longest(leads_to, &leads_to[node], visits)?;
                visits[node] = Visit::Done(below);
                below
            }
        };
        depth = depth.max(1 + below);
    }
    Ok(depth)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn longest_chain_of_ray_types() {
        let set = |items: &[usize]| items.iter().copied().collect::<BTreeSet<_>>();
        let path = |edges: &[&[usize]], roots: &[usize]| {
            let edges: Vec<_> = edges.iter().map(|e| set(e)).collect();
            longest(&edges, &set(roots), &mut vec![Visit::New; edges.len()])
        };
        assert_eq!(path(&[&[1], &[]], &[0]), Ok(2));
        assert_eq!(path(&[&[], &[]], &[0, 1]), Ok(1));
        assert_eq!(path(&[&[1], &[0]], &[0]), Err(0));
        assert_eq!(path(&[&[1], &[1]], &[]), Ok(0));
        assert_eq!(path(&[&[1, 2], &[2], &[]], &[0, 2]), Ok(3));
    }

    /// Depths of a pipeline with one ray type, whose programs are these: when each runs, and its code.
    fn depths(programs: &[(Place, &'static str, &str)], stated: [Option<u32>; 2]) -> Result<Depths, String> {
        use optix_device_rs::callable::{Continuation, Direct};
        use optix_device_rs::host::{
            CallableDescription, Entry, ExceptionsDescription, Frame, ParamsDescription, PayloadDescription,
            RayDescription,
        };
        unsafe fn nothing(_: &Frame<'_>) -> optix_device_rs::ray::Decision {
            unreachable!("not called")
        }
        const ENTRY: Entry = Entry { name: "", function: "", run: nothing };
        const TEST: PipelineDescription = PipelineDescription {
            name: "Test",
            params: ParamsDescription { name: "()", symbol: "", size: 0, align: 1, fields: &[], fingerprint: 0 },
            raygen: &[],
            rays: &[RayDescription { payload: PayloadDescription::of::<Bounce>(), miss: None }],
            hitgroups: &[],
            callables: &[
                CallableDescription::of::<(), fn(), Direct>(ENTRY),
                CallableDescription::of::<(), fn(), Continuation>(ENTRY),
            ],
            exceptions: ExceptionsDescription { throws: None, variants: &[], program: None },
            trace_depth: None,
            callable_depth: None,
        };
        let description = PipelineDescription { trace_depth: stated[0], callable_depth: stated[1], ..TEST };
        let mut text = String::new();
        for (_, name, code) in programs {
            text.push_str(&match name.split_once("__of_a_word") {
                Some(_) => format!(
                    ".visible .func  (.param .align 4 .b8 func_retval0[4]) {name}(\n.param .align 4 .b8 {name}_param_0[4]\n)\n"
                ),
                None if name.contains("callable") => format!(".visible .func {name}()\n"),
                None => format!(".visible .entry {name}()\n"),
            });
            text.push_str(&format!("{{\n{code}\n}}\n"));
        }
        let entries: Vec<_> = programs.iter().map(|&(place, name, _)| Reached { name, place }).collect();
        Depths::new(&description, &entries, Some(&Module::read(&text)), &mut |_, _, _| {})
            .map_err(|error| error.to_string())
    }

    #[derive(optix_device_rs::prelude::Payload)]
    pub struct Bounce {
        #[payload(write(caller), read(caller))]
        pub left: u32,
    }

    const DIRECT: &str = "call (%rd1), _optix_call_direct_callable, (%r1);";
    const DIRECT_OF_A_WORD: &str = "call (%rd1), _optix_call_direct_callable, (%r1);\n\
        prototype_0 : .callprototype (.param .align 4 .b8 _[4]) _ (.param .align 4 .b8 _[4]);";
    const CONTINUATION: &str = "call (%rd1), _optix_call_continuation_callable, (%r1);";
    const TRACE_RAY: &str = "call (%r1), _optix_trace_typed_32, (1, %rd1);";

    #[test]
    fn callables_count_where_they_are_called() {
        let raygen = (Place::RayGen, "__raygen__a", CONTINUATION);
        let continuation = (Place::Continuation, "__continuation_callable__c", "");
        let found = depths(&[raygen, continuation], [None; 2]).unwrap();
        assert_eq!((found.trace, found.continuation, found.direct_from_state), (0, 1, 0));
        assert!(!found.trace_is_a_promise);

        let anyhit = (Place::Traversal(0), "__anyhit__b", DIRECT);
        let direct = (Place::Direct, "__direct_callable__d", "");
        let found = depths(&[raygen, continuation, anyhit, direct], [None; 2]).unwrap();
        assert_eq!((found.direct_from_traversal, found.direct_from_state), (1, 0));
        assert_eq!(found.callables(), 2);
    }

    #[test]
    fn functions_count_where_they_are_called() {
        let helper = format!("call helper, ();\n}}\n.func helper()\n{{\n{TRACE_RAY} {DIRECT}");
        let raygen = (Place::RayGen, "__raygen__a", helper.as_str());
        let miss = (Place::Shading(0), "__miss__b", "");
        let direct = (Place::Direct, "__direct_callable__d", "");
        let found = depths(&[raygen, miss, direct], [None; 2]).unwrap();
        assert_eq!((found.trace, found.direct_from_state), (1, 1));
        // Without a record there is nothing to call.
        assert_eq!(depths(&[raygen, miss], [None; 2]).unwrap().direct_from_state, 0);
    }

    #[test]
    fn a_ray_type_that_is_no_constant_needs_a_depth() {
        let raygen = (Place::RayGen, "__raygen__a", "call (%r1), _optix_trace_typed_32, (%r2, %rd1);");
        let error = depths(&[raygen], [None; 2]).unwrap_err();
        assert!(error.contains("__raygen__a is not a constant") && error.contains("trace_depth: N"), "{error}");
        assert_eq!(depths(&[raygen], [Some(2), None]).unwrap().trace, 2);
    }

    #[test]
    fn callables_that_call_each_other_need_a_depth() {
        let raygen = (Place::RayGen, "__raygen__a", DIRECT);
        let direct = (Place::Direct, "__direct_callable__d", DIRECT);
        let error = depths(&[raygen, direct], [None; 2]).unwrap_err();
        assert!(error.contains("direct callables call each other") && error.contains("callable_depth: N"), "{error}");
        assert_eq!(depths(&[raygen, direct], [None, Some(3)]).unwrap().direct_from_state, 3);
        // What is stated counts only where callables nest.
        let leaf = (Place::Direct, "__direct_callable__d", "");
        assert_eq!(depths(&[raygen, leaf], [None, Some(3)]).unwrap().direct_from_state, 1);
    }

    #[test]
    fn chains_of_callables_are_as_deep_as_their_signatures_allow() {
        let raygen = (Place::RayGen, "__raygen__a", DIRECT);
        let upper = (Place::Direct, "__direct_callable__d", DIRECT_OF_A_WORD);
        let lower = (Place::Direct, "__direct_callable__e__of_a_word", "");
        assert_eq!(depths(&[raygen, upper, lower], [None; 2]).unwrap().direct_from_state, 2);
        assert_eq!(depths(&[raygen, upper, lower], [None, Some(5)]).unwrap().direct_from_state, 2);
        let anyhit = (Place::Traversal(0), "__anyhit__b", DIRECT_OF_A_WORD);
        let found = depths(&[raygen, anyhit, upper, lower], [None; 2]).unwrap();
        assert_eq!((found.direct_from_traversal, found.direct_from_state), (1, 2));
        let again = (Place::Direct, "__direct_callable__e__of_a_word", DIRECT_OF_A_WORD);
        let error = depths(&[raygen, upper, again], [None; 2]).unwrap_err();
        assert!(error.contains("inside of itself") && error.contains("callable_depth: N"), "{error}");
        // Nothing calls it.
        assert_eq!(depths(&[upper, again], [None; 2]).unwrap().direct_from_state, 0);
    }

    #[test]
    fn continuation_callables_trace_for_their_callers() {
        let raygen = (Place::RayGen, "__raygen__a", CONTINUATION);
        let continuation = (Place::Continuation, "__continuation_callable__c", TRACE_RAY);
        let miss = (Place::Shading(0), "__miss__b", "");
        assert_eq!(depths(&[raygen, continuation, miss], [None; 2]).unwrap().trace, 1);
        // The miss program calls what traces the ray that it ends.
        let again = (Place::Shading(0), "__miss__b", CONTINUATION);
        let error = depths(&[raygen, continuation, again], [None; 2]).unwrap_err();
        assert!(error.contains("recursively") && error.contains("trace_depth: N"), "{error}");
        let found = depths(&[raygen, continuation, again], [Some(5), None]).unwrap();
        assert_eq!((found.trace, found.trace_is_a_promise), (5, true));
    }
}
