//! Depths of small pipelines.

use super::super::programs::Stage;
use super::*;

/// Depths of a pipeline with one ray type, whose programs are these: when each runs, and its code.
fn depths(programs: &[(Stage, &'static str, &str)], stated: [Option<u32>; 2]) -> Result<Depths, String> {
    use optix_device_rs::callable::{Continuation, Direct};
    use optix_device_rs::host::{
        CallableDescription, Entry, ExceptionsDescription, Frame, ParamsDescription, PayloadDescription, RayDescription,
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
        programs.iter().map(|&(stage, name, _)| ReachedProgram { name, function: name, stage }).collect();
    Depths::new(&description, &entries, Some(&Module::read(&text)), &mut Notes::default())
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
    let raygen = (Stage::RayGen, "__raygen__a", CONTINUATION);
    let continuation = (Stage::Continuation, "__continuation_callable__c", "");
    let found = depths(&[raygen, continuation], [None; 2]).unwrap();
    assert_eq!((found.trace, found.continuation, found.direct_from_state), (0, 1, 0));
    assert!(!found.trace_is_stated);

    let anyhit = (Stage::Traversal(0), "__anyhit__b", DIRECT);
    let direct = (Stage::Direct, "__direct_callable__d", "");
    let found = depths(&[raygen, continuation, anyhit, direct], [None; 2]).unwrap();
    assert_eq!((found.direct_from_traversal, found.direct_from_state), (1, 0));
    assert_eq!(found.callables(), 2);
}

#[test]
fn functions_count_where_they_are_called() {
    let helper = format!("call helper, ();\n}}\n.func helper()\n{{\n{TRACE_RAY} {DIRECT}");
    let raygen = (Stage::RayGen, "__raygen__a", helper.as_str());
    let miss = (Stage::Shading(0), "__miss__b", "");
    let direct = (Stage::Direct, "__direct_callable__d", "");
    let found = depths(&[raygen, miss, direct], [None; 2]).unwrap();
    assert_eq!((found.trace, found.direct_from_state), (1, 1));
    // Without a record there is nothing to call.
    assert_eq!(depths(&[raygen, miss], [None; 2]).unwrap().direct_from_state, 0);
}

#[test]
fn a_ray_type_that_is_no_constant_needs_a_depth() {
    let raygen = (Stage::RayGen, "__raygen__a", "call (%r1), _optix_trace_typed_32, (%r2, %rd1);");
    let error = depths(&[raygen], [None; 2]).unwrap_err();
    assert!(error.contains("`__raygen__a` is not a constant") && error.contains("trace_depth: N"), "{error}");
    assert_eq!(depths(&[raygen], [Some(2), None]).unwrap().trace, 2);
}

#[test]
fn callables_that_call_each_other_need_a_depth() {
    let raygen = (Stage::RayGen, "__raygen__a", DIRECT);
    let direct = (Stage::Direct, "__direct_callable__d", DIRECT);
    let error = depths(&[raygen, direct], [None; 2]).unwrap_err();
    assert!(error.contains("direct callables call each other") && error.contains("callable_depth: N"), "{error}");
    assert_eq!(depths(&[raygen, direct], [None, Some(3)]).unwrap().direct_from_state, 3);
    // What is stated counts only where callables nest.
    let leaf = (Stage::Direct, "__direct_callable__d", "");
    assert_eq!(depths(&[raygen, leaf], [None, Some(3)]).unwrap().direct_from_state, 1);
}

#[test]
fn chains_of_callables_are_as_deep_as_their_signatures_allow() {
    let raygen = (Stage::RayGen, "__raygen__a", DIRECT);
    let upper = (Stage::Direct, "__direct_callable__d", DIRECT_OF_A_WORD);
    let lower = (Stage::Direct, "__direct_callable__e__of_a_word", "");
    assert_eq!(depths(&[raygen, upper, lower], [None; 2]).unwrap().direct_from_state, 2);
    assert_eq!(depths(&[raygen, upper, lower], [None, Some(5)]).unwrap().direct_from_state, 2);
    let anyhit = (Stage::Traversal(0), "__anyhit__b", DIRECT_OF_A_WORD);
    let found = depths(&[raygen, anyhit, upper, lower], [None; 2]).unwrap();
    assert_eq!((found.direct_from_traversal, found.direct_from_state), (1, 2));
    let again = (Stage::Direct, "__direct_callable__e__of_a_word", DIRECT_OF_A_WORD);
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
    let raygen = (Stage::RayGen, "__raygen__a", CONTINUATION);
    let continuation = (Stage::Continuation, "__continuation_callable__c", TRACE_RAY);
    let miss = (Stage::Shading(0), "__miss__b", "");
    assert_eq!(depths(&[raygen, continuation, miss], [None; 2]).unwrap().trace, 1);
    // The miss program calls what traces the ray that it ends.
    let again = (Stage::Shading(0), "__miss__b", CONTINUATION);
    let error = depths(&[raygen, continuation, again], [None; 2]).unwrap_err();
    assert!(error.contains("recursively") && error.contains("trace_depth: N"), "{error}");
    let found = depths(&[raygen, continuation, again], [Some(5), None]).unwrap();
    assert_eq!((found.trace, found.trace_is_stated), (5, true));
}

#[test]
fn a_stated_trace_depth_is_compared_with_the_programs() {
    let raygen = (Stage::RayGen, "__raygen__a", TRACE_RAY);
    let silent = (Stage::Shading(0), "__miss__b", "");
    // More than needed is taken, and can't be exceeded.
    for stated in [None, Some(1), Some(7)] {
        let found = depths(&[raygen, silent], [stated, None]).unwrap();
        assert_eq!((found.trace, found.trace_is_stated), (stated.unwrap_or(1), false));
    }
    let error = depths(&[raygen, silent], [Some(0), None]).unwrap_err();
    assert!(error.contains("`trace_depth: 0`") && error.contains("`__raygen__a` traces `Bounce`"), "{error}");
    // By a callable.
    let calls = (Stage::RayGen, "__raygen__a", CONTINUATION);
    let callable = (Stage::Continuation, "__continuation_callable__c", TRACE_RAY);
    let error = depths(&[calls, callable, silent], [Some(0), None]).unwrap_err();
    assert!(error.contains("`__continuation_callable__c` traces `Bounce`"), "{error}");
    // Without an end, one step has to be possible.
    let again = (Stage::Shading(0), "__closesthit__d", TRACE_RAY);
    let error = depths(&[raygen, silent, again], [Some(1), None]).unwrap_err();
    for part in
        ["`trace_depth: 1`", "2 deep", "`__raygen__a` traces `Bounce`, `__closesthit__d` traces `Bounce`", "state 2"]
    {
        assert!(error.contains(part), "no `{part}` in: {error}");
    }
    let found = depths(&[raygen, silent, again], [Some(2), None]).unwrap();
    assert_eq!((found.trace, found.trace_is_stated), (2, true));
}
