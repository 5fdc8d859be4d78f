//! Which programs a launch reaches, and how deep their calls nest (guide 6.7, 6.8).

use crate::error::PipelineError;
use crate::limits::{MAX_CALLABLE_DEPTH, MAX_TRACE_DEPTH};
use crate::{Error, Result};
use optix_device_rs::host::{Entry, PipelineDescription};
use optix_ptx::{Function, Module, Prototype};
use std::collections::{BTreeMap, BTreeSet, VecDeque};

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
    /// As its source calls it, for messages.
    function: &'static str,
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
    let mut add = |entry: Entry, place| {
        if !entries.iter().any(|e| e.name == entry.name && e.place == place) {
            entries.push(Reached { name: entry.name, function: entry.function, place });
        }
    };
    for raygen in description.raygen {
        add(raygen.entry, Place::RayGen);
    }
    for (ray, of) in description.rays.iter().enumerate() {
        if let Some(miss) = of.miss {
            add(miss.entry, Place::Shading(ray));
        }
        for &group in groups {
            let programs = description.hitgroups[group].rays[ray];
            if let Some(entry) = programs.closesthit {
                add(entry, Place::Shading(ray));
            }
            for entry in [programs.anyhit, programs.intersection].into_iter().flatten() {
                add(entry, Place::Traversal(ray));
            }
        }
    }
    for callable in callables.iter().map(|&index| &description.callables[index]) {
        add(callable.entry, if callable.continuation { Place::Continuation } else { Place::Direct });
    }
    if let Some(program) = description.exceptions.program {
        add(program.entry, Place::Exception);
    }
    entries
}

/// How deep calls nest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Depths {
    /// Trace calls.
    pub trace: u32,
    /// Whether the trace depth holds only because the declaration says so: the programs may trace deeper, for all that can be seen.
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
        let error = |error| Error::Pipeline { pipeline: description.name, error };
        let programs = module.map(|module| programs(entries, module).map_err(error)).transpose()?;
        let programs = programs.as_deref();
        let (trace, is_a_promise, why) = trace(description, programs).map_err(error)?;
        note("trace depth", trace.to_string(), why);
        let mut depths = Self {
            trace,
            trace_is_a_promise: is_a_promise,
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
                        "the longest chain of calls in the compiled programs, or where that has no end what the declaration states"
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
    ) -> Result<(), PipelineError> {
        let is_state = |place| matches!(place, Place::RayGen | Place::Shading(_) | Place::Continuation);
        let Some(programs) = programs else {
            let depth = description.callable_depth.unwrap_or(MAX_CALLABLE_DEPTH);
            (self.continuation, self.direct_from_traversal, self.direct_from_state) = (depth, depth, depth);
            return Ok(());
        };
        let depth = |kind: &CallableKind, from: fn(Place) -> bool| {
            let callables: Vec<_> = programs.iter().filter(|program| program.reached.place == kind.place).collect();
            let function = |callable: usize| callables[callable].reached.function;
            let (roots, leads_to) = calls(programs, &callables, kind, from);
            match nesting(&leads_to, &roots, description.callable_depth) {
                Ok(Nesting::Known(depth) | Nesting::Promised(depth)) => Ok(depth),
                Err(Misfit::Endless(callable)) => {
                    Err(PipelineError::EndlessCallables { kind: kind.name, callable: function(callable) })
                }
                Err(Misfit::Deeper(chain, stated)) => {
                    let chain = chain.into_iter().map(function).collect();
                    Err(PipelineError::CallableDepth { kind: kind.name, stated, chain })
                }
            }
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

fn programs<'e, 'a>(entries: &'e [Reached], module: &Module<'a>) -> Result<Vec<Program<'e, 'a>>, PipelineError> {
    let program = |reached: &'e Reached| {
        let functions = module.reached(reached.name);
        if functions.is_empty() {
            return Err(PipelineError::MissingEntry { entry: reached.name });
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

/// Which callables of a kind the programs that run at these places call, and which each callable calls: those that take and
/// give what is called with.
fn calls(
    programs: &[Program<'_, '_>],
    callables: &[&Program<'_, '_>],
    kind: &CallableKind,
    from: fn(Place) -> bool,
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
    (programs.iter().filter(|program| from(program.reached.place)).flat_map(called).collect(), leads_to)
}

/// How deep trace calls nest, whether that is only a promise, and why: the longest path from ray generation over ray types,
/// where a ray type leads to those that its programs trace, and a call of a continuation callable to those that any of them
/// traces.
fn trace(
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
        Ok(Nesting::Promised(depth)) => {
            Ok((depth, true, "stated in the pipeline's declaration: the programs trace rays recursively".into()))
        }
        Err(Misfit::Endless(node)) => Err(PipelineError::EndlessTraces { ray: ray(node) }),
        Err(Misfit::Deeper(chain, stated)) => {
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
        for program in programs.iter().filter(|program| program.reached.place == Place::Continuation) {
            by_callables.extend(traced(program)?);
        }
        let mut all = Self { roots: BTreeSet::new(), leads_to: vec![BTreeSet::new(); rays], who: BTreeMap::new() };
        for program in programs {
            let (from, to) = match program.reached.place {
                Place::RayGen => (None, &mut all.roots),
                Place::Shading(ray) => (Some(ray), &mut all.leads_to[ray]),
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

/// How deep nodes nest.
enum Nesting {
    /// As deep as the longest path.
    Known(u32),
    /// The paths have no end, and this deep is stated.
    Promised(u32),
}

/// Why it can't be said how deep.
enum Misfit {
    /// The node leads to itself, and nothing is stated.
    Endless(usize),
    /// A path that is longer than what is stated.
    Deeper(Vec<usize>, u32),
}

/// How deep nodes nest, from these. Where they nest without end, what is stated is believed, unless it is too little for a step
/// on the shortest path to it.
fn nesting(leads_to: &[BTreeSet<usize>], from: &BTreeSet<usize>, stated: Option<u32>) -> Result<Nesting, Misfit> {
    let found = longest(leads_to, from, &mut vec![Visit::New; leads_to.len()]);
    let chain = match (&found, stated) {
        (Ok(chain), _) => chain,
        (Err(node), None) => return Err(Misfit::Endless(*node)),
        (Err(_), Some(_)) => &shortest(leads_to, from),
    };
    let depth = chain.len() as u32;
    match stated {
        Some(stated) if stated < depth => Err(Misfit::Deeper(chain.clone(), stated)),
        Some(stated) if found.is_err() => Ok(Nesting::Promised(stated)),
        _ => Ok(Nesting::Known(depth)),
    }
}

/// The path that is longest of those that lead to a step as soon as can be.
fn shortest(leads_to: &[BTreeSet<usize>], from: &BTreeSet<usize>) -> Vec<usize> {
    let mut met = BTreeSet::new();
    let mut queue: VecDeque<Vec<usize>> = from.iter().map(|&node| vec![node]).collect();
    let mut last = Vec::new();
    while let Some(path) = queue.pop_front() {
        if let Some(&node) = path.last()
            && met.insert(node)
        {
            queue.extend(leads_to[node].iter().map(|&next| [&path[..], &[next]].concat()));
        }
        // In order of their lengths.
        last = path;
    }
    last
}

/// What is known of a node.
#[derive(Clone)]
enum Visit {
    New,
    OnPath,
    /// The longest path from here, without this.
    Done(Vec<usize>),
}

/// The longest path from any of `from`; the error is a node that leads to itself.
fn longest(leads_to: &[BTreeSet<usize>], from: &BTreeSet<usize>, visits: &mut [Visit]) -> Result<Vec<usize>, usize> {
    let mut path = Vec::new();
    for &node in from {
        let below = match &visits[node] {
            Visit::OnPath => return Err(node),
            Visit::Done(below) => below.clone(),
            Visit::New => {
                visits[node] = Visit::OnPath;
                let below = longest(leads_to, &leads_to[node], visits)?;
                visits[node] = Visit::Done(below.clone());
                below
            }
        };
        if below.len() >= path.len() {
            path = [&[node], &below[..]].concat();
        }
    }
    Ok(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn longest_chain_of_ray_types() {
        let set = |items: &[usize]| items.iter().copied().collect::<BTreeSet<_>>();
        let path = |edges: &[&[usize]], roots: &[usize]| {
            let edges: Vec<_> = edges.iter().map(|e| set(e)).collect();
            longest(&edges, &set(roots), &mut vec![Visit::New; edges.len()]).map(|path| path.len())
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
        const ENTRY: Entry = Entry { name: "", function: "", body: nothing };
        const TEST: PipelineDescription = PipelineDescription {
            name: "Test",
            params: ParamsDescription { name: "()", symbol: "", size: 0, align: 1, fields: &[] },
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
            crossings: &[],
            layouts: "",
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
        let entries: Vec<_> =
            programs.iter().map(|&(place, name, _)| Reached { name, function: name, place }).collect();
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
        assert!(error.contains("`__raygen__a` is not a constant") && error.contains("trace_depth: N"), "{error}");
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
        let error = depths(&[raygen, upper, lower], [None, Some(1)]).unwrap_err();
        assert!(
            error.contains("`callable_depth: 1`")
                && error.contains("2 deep")
                && error.contains("`__direct_callable__d` calls `__direct_callable__e__of_a_word`"),
            "{error}"
        );
        // A call of itself is two deep at the least.
        let error = depths(&[raygen, upper, again], [None, Some(1)]).unwrap_err();
        assert!(error.contains("2 deep") && error.contains("state 2"), "{error}");
        assert_eq!(depths(&[raygen, upper, again], [None, Some(2)]).unwrap().direct_from_state, 2);
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

    #[test]
    fn a_stated_trace_depth_is_compared_with_the_programs() {
        let raygen = (Place::RayGen, "__raygen__a", TRACE_RAY);
        let silent = (Place::Shading(0), "__miss__b", "");
        // More than needed is taken, and can't be exceeded.
        for stated in [None, Some(1), Some(7)] {
            let found = depths(&[raygen, silent], [stated, None]).unwrap();
            assert_eq!((found.trace, found.trace_is_a_promise), (stated.unwrap_or(1), false));
        }
        let error = depths(&[raygen, silent], [Some(0), None]).unwrap_err();
        assert!(error.contains("`trace_depth: 0`") && error.contains("`__raygen__a` traces `Bounce`"), "{error}");
        // By a callable.
        let calls = (Place::RayGen, "__raygen__a", CONTINUATION);
        let callable = (Place::Continuation, "__continuation_callable__c", TRACE_RAY);
        let error = depths(&[calls, callable, silent], [Some(0), None]).unwrap_err();
        assert!(error.contains("`__continuation_callable__c` traces `Bounce`"), "{error}");
        // Without an end, one step has to be possible.
        let again = (Place::Shading(0), "__closesthit__d", TRACE_RAY);
        let error = depths(&[raygen, silent, again], [Some(1), None]).unwrap_err();
        for part in [
            "`trace_depth: 1`",
            "2 deep",
            "`__raygen__a` traces `Bounce`, `__closesthit__d` traces `Bounce`",
            "state 2",
        ] {
            assert!(error.contains(part), "no `{part}` in: {error}");
        }
        let found = depths(&[raygen, silent, again], [Some(2), None]).unwrap();
        assert_eq!((found.trace, found.trace_is_a_promise), (2, true));
    }

    #[test]
    fn shortest_ways_to_each_step() {
        let set = |items: &[usize]| items.iter().copied().collect::<BTreeSet<_>>();
        let path = |edges: &[&[usize]], roots: &[usize]| {
            shortest(&edges.iter().map(|e| set(e)).collect::<Vec<_>>(), &set(roots))
        };
        assert_eq!(path(&[&[0]], &[0]), [0, 0]);
        assert_eq!(path(&[&[1], &[2], &[0]], &[0]), [0, 1, 2, 0]);
        assert_eq!(path(&[&[1, 2], &[2], &[]], &[0]), [0, 1, 2]);
        assert_eq!(path(&[&[1], &[1]], &[]), [0; 0]);
    }
}
