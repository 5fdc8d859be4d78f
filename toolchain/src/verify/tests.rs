//! Each check on a PTX that is right, and on the same with one thing wrong.

use super::*;

/// A module as the toolkit compiles it, shortened: two ray types, one program of each kind.
const PTX: &str = include_str!("tests/sound.ptx");

fn program(kind: Kind, function: &str, ray: Option<usize>, material: Option<&str>) -> Program {
    let entry = format!("__{}__Demo_{function}_0123abcd", kind.word());
    let primitive = material.map(|material| if material == "Ball" { "Custom" } else { "Triangles" }.to_string());
    let queries = ["_optix_get_triangle_barycentrics", "_optix_get_triangle_vertex_data_current_hit"];
    let undefined = if material == Some("Ball") { queries.map(str::to_string).into() } else { Vec::new() };
    let material = material.map(str::to_string);
    Program { kind, entry, function: function.into(), ray, material, primitive, undefined }
}

fn crossing(what: &str, name: &str, size: usize, unit: &str, layout: u64) -> Crossing {
    Crossing { what: what.into(), name: name.into(), size, unit: unit.into(), layout }
}

fn demo() -> Pipeline {
    let field = |name: &str, offset, size, bound| Field { name: name.into(), offset, size, bound };
    Pipeline {
        name: "Demo".into(),
        params: Params {
            name: "Frame".into(),
            symbol: "optix_params_Frame_89abcdef".into(),
            size: 32,
            align: 8,
            fields: vec![
                field("world", 0, 8, false),
                field("bounces", 8, 4, true),
                field("sun", 12, 12, false),
                field("flag", 24, 1, true),
                field("small", 26, 2, true),
            ],
        },
        rays: vec![
            // Word 0: write(closesthit, miss), read(caller). Word 1: write(caller, anyhit), read(closesthit, anyhit).
            Ray { payload: "Radiance".into(), semantics: vec![8 | 32 | 1, 2 | 128 | 4 | 64], memory_words: 0 },
            Ray { payload: "Shadow".into(), semantics: vec![2 | 32 | 1], memory_words: 0 },
        ],
        throws: Some("Fault".into()),
        layouts: "optix_layouts_Demo_0123abcd".into(),
        crossings: vec![
            crossing("launch parameters", "Frame", 32, "bytes", 7),
            crossing("payload", "Radiance", 2, "words", 8),
        ],
        programs: vec![
            program(Kind::RayGen, "camera", None, None),
            program(Kind::Miss, "sky", Some(0), None),
            program(Kind::ClosestHit, "shade", Some(0), Some("Lambert")),
            program(Kind::AnyHit, "cut_out", Some(0), Some("Lambert")),
            program(Kind::Intersection, "ball", Some(1), Some("Ball")),
            program(Kind::DirectCallable, "wood", None, None),
            program(Kind::ContinuationCallable, "mirror", None, None),
            program(Kind::Exception, "report", None, None),
        ],
    }
}

/// The findings after `from` has become `to` wherever it stands.
fn findings(from: &str, to: &str) -> Vec<String> {
    assert!(PTX.contains(from), "{from}");
    let findings = check(&PTX.replace(from, to), &[demo()], &["helper".into()]);
    findings.iter().map(Finding::to_string).collect()
}

/// One finding, which contains all of `says`.
#[track_caller]
fn one(from: &str, to: &str, says: &[&str]) {
    let findings = findings(from, to);
    assert_eq!(findings.len(), 1, "{findings:#?}");
    for part in says {
        assert!(findings[0].contains(part), "{part:?} in {:?}", findings[0]);
    }
}

#[test]
fn a_sound_module_has_no_findings() {
    assert_eq!(findings("", ""), [] as [&str; 0]);
}

#[test]
fn entries() {
    let shade = "closest-hit program `shade` of `Demo` (material `Lambert`, ray `Radiance`)";
    let renamed = findings("__closesthit__Demo_shade_0123abcd", "__closesthit__other");
    assert!(renamed[0].contains("error[entry]") && renamed[0].contains(shade), "{renamed:?}");
    assert!(renamed[0].contains("there is no entry `__closesthit__Demo_shade_0123abcd`"), "{renamed:?}");
    assert!(renamed[1].contains("warning[entry]") && renamed[1].contains("`__closesthit__other`"), "{renamed:?}");
    one("__miss__Demo_sky_0123abcd()", "__miss__Demo_sky_0123abcd(.param .b64 a)", &["`sky`", "has parameters"]);
    one("// end", ".visible .entry __miss__Demo_sky_0123abcd()\n{\n}\n", &["`sky`", "2 entries"]);

    let mut wrong = demo();
    wrong.programs[1].kind = Kind::Intersection;
    wrong.programs[1].ray = Some(0);
    let text = check(PTX, &[wrong], &["helper".into()])[0].to_string();
    assert!(text.contains("does not begin with `__intersection__`"), "{text}");
}

#[test]
fn the_parameters_variable() {
    let declaration = ".visible .const .align 8 .b8 optix_params_Frame_89abcdef[32];";
    let one = |to: &str, says: &str| one(declaration, to, &["error[params-symbol]", "`Frame` of `Demo`", says]);
    one("", "there is no constant-memory variable");
    one(&format!("{declaration}\n{declaration}"), "2 times");
    one(&declaration.replace("32", "40"), "the PTX has 40 bytes for them, the host 32");
    one(&declaration.replace("align 8", "align 4"), "the PTX aligns them to 4 bytes, the host to 8");
    one(&declaration.replace(".const", ".global"), "there is no constant-memory variable");
}

#[test]
fn layouts() {
    let table = ".visible .global .align 8 .b64 optix_layouts_Demo_0123abcd[4] = {32, 7, 2, 8};";
    let one = |to: &str, item: &str, says: &str| one(table, to, &["error[layout]", item, says]);
    one("", "pipeline `Demo`", "does not have its layouts");
    one(&table.replace("32, 7, ", ""), "pipeline `Demo`", "1 types cross in the PTX, 2 on the host");
    one(&table.replace("32", "40"), "launch parameters `Frame` of `Demo`", "the PTX has 40 bytes of it, the host 32");
    one(&table.replace("2, 8", "2, -8"), "payload `Radiance` of `Demo`", "of its 2 words the PTX makes other fields");
}

#[test]
fn primitives() {
    let hit = "// ball";
    for query in ["barycentrics", "vertex_data_current_hit"] {
        let call = format!("call (%f1, %f2), _optix_get_triangle_{query}, ();");
        one(hit, &call, &["error[primitive]", "intersection program `ball`", query, "undefined for hits on `Custom`"]);
        assert_eq!(findings("call _optix_ignore_intersection, ();", &call), [] as [&str; 0]);
    }
}

#[test]
fn loads_of_parameters() {
    let load = "ld.const.b32 %r3, [optix_params_Frame_89abcdef+8];";
    let one = |to: &str, says: &[&str]| {
        one(load, to, says);
        one(load, to, &["params-load]", "ray-generation program `camera` of `Demo`"]);
    };
    let at = |op: &str, offset| format!("{op} %r3, [optix_params_Frame_89abcdef+{offset}];");
    one(&at("ld.const.b32", 10), &["bytes 10..14", "`bounces` 8..12, `sun` 12..24"]);
    one(&at("ld.const.b32", 14), &["no element of the field `Frame::sun` at 12..24"]);
    one(&at("ld.const.b32", 28), &["bytes 28..32", "not inside of one field"]);
    one(&at("ld.const.b64", 8), &["bytes 8..16", "not inside of one field"]);
    one("ld.const.v2.b32 {%r3, %r4}, [optix_params_Frame_89abcdef+8];", &["bytes 8..16"]);
    one("ld.const.v4.u8 {%r3, %r4, %r5, %r6}, [optix_params_Frame_89abcdef+8];", &["`Frame::bounces`", "specialised"]);
    one(&at("ld.const.u8", 8), &["warning", "the bound field `Frame::bounces` in pieces of 1 byte"]);
    one("mov.b64 %rd8, optix_params_Frame_89abcdef; cvta.const.u64 %rd9, %rd8;", &["takes the address", "no field"]);
    one("ld.const.b32 %r3, [optix_params_Frame_89abcdef+%rd1];", &["takes the address"]);
    for good in [
        at("ld.const.b32", 20),
        at("ld.const.u8", 24),
        at("ld.const.b32", 4),
        at("mov.b32", 0).replace("optix_params_Frame_89abcdef", "optix_params_Frame_89abcdef2"),
    ] {
        assert_eq!(findings(load, &good), [] as [&str; 0]);
    }
    let pieces = findings(load, &at("ld.const.u8", 27));
    assert!(pieces[0].contains("warning") && pieces[0].contains("`Frame::small`"), "{pieces:?}");

    let mut large = demo();
    large.params.fields.push(Field { name: "table".into(), offset: 32, size: 256, bound: false });
    let text = PTX.replace(load, "mov.b64 %rd8, optix_params_Frame_89abcdef;");
    let found = check(&text, &[large], &["helper".into()]);
    assert_eq!(found[0].level, Level::Warning);
    assert!(found[0].message.contains("`Frame::table` (256 bytes) through a pointer"), "{}", found[0]);
}

#[test]
fn parameters_of_another_pipeline() {
    let mut other = demo();
    other.name = "Other".into();
    other.params.name = "OtherFrame".into();
    other.params.symbol = "optix_params_Other_00000000".into();
    other.programs.clear();
    let text = PTX
        .replace("// end", ".visible .const .align 8 .b8 optix_params_Other_00000000[32];\n")
        .replace("[optix_params_Frame_89abcdef+8]", "[optix_params_Other_00000000+8]");
    let found = check(&text, &[demo(), other], &["helper".into()]);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].message.contains("`OtherFrame`, which are those of `Other`"), "{}", found[0]);
}

#[test]
fn payload_types() {
    let miss = "mov.b32 %r1, 1; // miss type\n\tcall _optix_set_payload_types, (%r1);";
    let one = |to: &str, says: &str| one(miss, to, &["error[payload-type]", "miss program `sky` of `Demo`", says]);
    one("call _optix_set_payload_types, (2);", "type 2 (`Shadow`), but it runs for type 1 (`Radiance`)");
    one("call _optix_set_payload_types, (3);", "type 3 (`Radiance` and `Shadow`)");
    one("call _optix_set_payload_types, (4);", "type 4 (no ray type of `Demo`)");
    one("call _optix_set_payload_types, (%r9);", "not a constant");
    one("", "does not announce its payload type, 1 (`Radiance`)");
    one(&format!("{miss}\n{miss}"), "2 times");
    one("call _optix_set_payload, (0, %r9); call _optix_set_payload_types, (1);", "after it has used the payload");
    let camera = "ld.const.b32 %r3, [optix_params_Frame_89abcdef+8];";
    super::tests::one(camera, "call _optix_set_payload_types, (1);", &["`camera`", "although it has no payload"]);
}

#[test]
fn payload_words() {
    let set = "call _optix_set_payload, (%r2, %r5); // miss word";
    let one = |to: &str, says: &str| one(set, to, &["error[payload-word]", "miss program `sky` of `Demo`", says]);
    one(
        "call _optix_set_payload, (1, %r5);",
        "sets payload word 1, which `Radiance` does not let be written by miss programs",
    );
    one("call _optix_set_payload, (2, %r5);", "sets payload word 2, but `Radiance` has 2 words");
    one("call _optix_set_payload, (%r5, %r5);", "not a constant");
    one(
        "call (%r6), _optix_get_payload, (0);",
        "gets payload word 0, which `Radiance` does not let be read by miss programs",
    );
    let camera = "ld.const.b32 %r3, [optix_params_Frame_89abcdef+8];";
    super::tests::one(camera, "call (%r3), _optix_get_payload, (0);", &["`camera`", "although it has no payload"]);
}

#[test]
fn trace_calls() {
    let arguments = "%r20, %r21, %r22, %r23, %r24, %r25";
    let shadow = ["`camera`", "error[trace]"];
    // Mask, flags, offset, stride, miss index and word count are the registers 20 to 25, the type is register 10.
    let replaced = |register: &str, by: &str| arguments.replace(register, by);
    let check = |to: String, says: &str| one(arguments, &to, &[shadow[0], shadow[1], says]);
    check(replaced("%r22", "0"), "ray `Shadow` with SBT offset 0 in place of 1");
    check(replaced("%r23", "1"), "ray `Shadow` with SBT stride 1 in place of 2");
    check(replaced("%r24", "0"), "ray `Shadow` with miss index 0 in place of 1");
    check(replaced("%r25", "2"), "ray `Shadow` with payload word count 2 in place of 1");
    check(replaced("%r23", "%r3"), "its SBT stride is not a constant");
    check(replaced("%r25", "%r25, none"), "passes 50 arguments");
    one("mov.b32 %r10, 2;", "mov.b32 %r10, 4;", &["payload type 4, which is no ray type of `Demo`"]);
    one("mov.b32 %r10, 2;", "mov.b32 %r10, 3;", &["payload type 3"]);
    one("mov.b32 %r10, 2;", "", &["payload type is not a constant"]);
    one("_optix_trace_typed_32", "_optix_trace_8", &["calls `_optix_trace_8`"]);

    let any_hit = "call _optix_ignore_intersection, ();";
    let found = findings(any_hit, "call (%r1), _optix_trace_typed_32, (1);");
    assert!(found[0].contains("any-hit program `cut_out`") && found[0].contains("does not allow"), "{found:?}");
}

#[test]
fn what_a_called_function_does_counts() {
    let helper = "call (%r2), _optix_get_payload, (%r1); // helper";
    let path =
        "closest-hit program `shade` of `Demo` (material `Lambert`, ray `Radiance`), in `demo::helper`, which it calls";
    one(helper, "call (%r2), _optix_get_payload, (0);", &[path, "gets payload word 0"]);
}

#[test]
fn memory_and_calls() {
    let depot = "// depot";
    one(depot, ".local .align 4 .b8 __local_depot0[16];", &["error[local-memory]", "miss program `sky`", "16 bytes"]);
    one(depot, "call (%r1), %rd1, (), prototype_0;", &["error[call]", "miss program `sky`", "through a pointer"]);
    one("// end", ".extern .func missing\n();\n", &["error[module]", "missing"]);

    // Ten words of a payload by pointer, of a ray that the program traces, are what the source asks for.
    let mut pointer = demo();
    pointer.rays[1].memory_words = 10;
    let with = |bytes: usize| {
        let head = ".visible .entry __raygen__Demo_camera_0123abcd()\n{\n";
        assert!(PTX.contains(head));
        PTX.replace(head, &format!("{head}\t.local .align 16 .b8 __local_depot0[{bytes}];\n"))
    };
    let helper = ["helper".to_string()];
    assert_eq!(check(&with(48), &[pointer.clone()], &helper), []);
    let found = check(&with(64), &[pointer], &helper);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].to_string().contains("64 bytes in local memory, 48 of them for payloads"), "{}", found[0]);

    // The toolkit's own function for large angles is meant to be called.
    let large = PTX.replace("_ZN4demo6helper17h0123456789abcdefE", "_RNvNtCs9Z4UwyQbes2_4libm7sin_cos12reduce_large");
    assert_ne!(large, PTX);
    assert_eq!(check(&large, &[demo()], &[]), []);

    let found = check(PTX, &[demo()], &[]);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].item, "function `demo::helper`");
    assert!(found[0].message.starts_with("is called, not inlined, by closest-hit program `shade`"), "{}", found[0]);
}

#[test]
fn callables_and_exceptions() {
    let one = |from: &str, to: &str, says: &[&str]| one(from, to, &[&["error[callable]"], says].concat());
    let any_hit = "call _optix_ignore_intersection, ();";
    let may_not = "does not allow";
    one(
        any_hit,
        "call (%rd1), _optix_call_continuation_callable, (%r1);",
        &["any-hit program `cut_out`", "calls a continuation callable", may_not],
    );
    let wood = "// wood";
    one(wood, "call (%rd7), _optix_call_continuation_callable, (%r1);", &["direct callable `wood` of `Demo`", may_not]);
    let report = "// report";
    let exception = "exception program `report` of `Demo`";
    one(report, "call (%rd7), _optix_call_direct_callable, (%r1);", &[exception, "calls a direct callable", may_not]);
    one(report, "call _optix_throw_exception_0, (%r1);", &[exception, "throws an exception", may_not]);
    let trace = findings(wood, "call (%r1), _optix_trace_typed_32, (1);");
    assert!(trace[0].contains("direct callable `wood`") && trace[0].contains(may_not), "{trace:?}");
    super::tests::one(wood, "call (%r1), %rd8, (), prototype_0;", &["error[call]", "`wood`", "through a pointer"]);

    let mut silent = demo();
    silent.throws = None;
    let found = check(PTX, &[silent], &["helper".into()]);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].message.contains("`Demo` does not say what its programs throw"), "{}", found[0]);
}

#[test]
fn forbidden_instructions_are_found_in_every_kind_of_program() {
    for program in demo().programs {
        let item = program.item(&demo());
        let head = format!("{}()\n{{\n", program.entry);
        let head = if PTX.contains(&head) { head } else { format!("{}(", program.entry) };
        assert!(PTX.contains(&head), "{item}");
        // Behind the brace that opens its body.
        let begin = PTX.find(&head).expect("it is there");
        let body = begin + PTX[begin..].find('{').expect("a body") + 1;
        for (line, level, says) in [
            ("bar.sync 0;", "error", "`bar.sync` works together with other threads"),
            ("ld.shared.b32 %r1, [%r2];", "error", "`ld.shared.b32` uses shared memory"),
            ("shfl.sync.idx.b32 %r1, %r2, 0, 31, -1;", "error", "`shfl.sync.idx.b32` works together"),
            ("mov.u32 %r1, %envreg0;", "error", "`%envreg0` is a register that is not there"),
            ("mov.u32 %r1, %tid.x;", "warning", "`%tid.x` has another meaning"),
            ("activemask.b32 %r1;", "warning", "`activemask.b32` says something of the thread's place"),
            ("fence.acq_rel.gpu;", "warning", "`fence.acq_rel.gpu` is a memory fence"),
        ] {
            let text = format!("{}\n\t{line}\n{}", &PTX[..body], &PTX[body..]);
            let found = check(&text, &[demo()], &["helper".into()]);
            assert_eq!(found.len(), 1, "{item}, {line}: {found:#?}");
            let text = found[0].to_string();
            assert!(text.starts_with(&format!("{level}[instruction]: {item}: {says}")), "{text}");
        }
        let local = "\t.local .align 4 .b8 \t__local_depot0[4];\nmov.b64 %rd90, __local_depot0;\ncvta.local.u64 %rd91, %rd90;\n\
                     atom.add.u32 %r1, [%rd91], 1;";
        let text = format!("{}\n{local}\n{}", &PTX[..body], &PTX[body..]);
        let found = check(&text, &[demo()], &["helper".into()]);
        assert!(
            found.iter().any(|f| f.rule == Rule::Instruction && f.item == item && f.message.contains("atom.add.u32"))
        );
    }
    // In a function that a program calls, and in no function.
    one(
        "mov.b32 %r1, 1;\n\tcall (%r2), _optix_get_payload, (%r1); // helper",
        "bar.sync 0; mov.b32 %r1, 1;\n\tcall (%r2), _optix_get_payload, (%r1); // helper",
        &["error[instruction]", "closest-hit program `shade`", "in `demo::helper`, which it calls"],
    );
    one("// end", ".shared .align 4 .b8 pool[16];\n", &["error[instruction]: the module: `pool` uses shared memory"]);
}
