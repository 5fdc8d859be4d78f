//! `cargo optix inspect` on a crate of the workspace.

mod common;

use std::path::Path;
use std::process::Command;

use optix_toolchain::inspect::{Class, programs, ptxas::Ptxas, with_source};
use optix_toolchain::json::Json;
use optix_toolchain::{Codegen, Error, Shaders};

const GOLDEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/golden/typed");

#[test]
fn the_goldens_cost_what_they_do() {
    if !common::can_compile("the_goldens_cost_what_they_do") {
        return;
    }
    let built = Shaders::new(GOLDEN).line_info(true).compile_in(common::area()).expect("it compiles");
    let programs = programs(&built.text);
    let program = |part: &str| programs.iter().find(|program| program.name.contains(part)).expect(part);

    let shade = program("__closesthit__Golden_shade");
    assert_eq!((shade.record.count, shade.record.bytes), (4, 16), "a record of one colour and an index");
    assert_eq!((shade.local_memory, shade.count(Class::Double)), (0, 0));
    assert_eq!(program("__raygen__Golden_caller").calls.get("_optix_trace_typed_32"), Some(&1));
    assert_eq!(program("__raygen__Golden_wide").parameters.count, 3);

    let Some(ptxas) = Ptxas::find() else {
        eprintln!("the_goldens_cost_what_they_do: no registers: no ptxas");
        return;
    };
    for arch in ["sm_75", "sm_90"] {
        let usages = ptxas.usage(&built.text, arch, &common::area()).expect("it assembles");
        // Of callables, which are functions and no entries, ptxas says nothing.
        let entries = programs.iter().filter(|program| !program.name.contains("_callable__")).count();
        assert_eq!(usages.len(), entries);
        for usage in usages {
            assert!(usage.registers.is_some_and(|registers| (8..64).contains(&registers)), "{usage:?}");
            assert_eq!(usage.spill_stores, 0, "{usage:?}");
        }
    }
}

/// Without line information there are as many instructions: it changes none.
#[test]
fn lines_are_known_through_both_generators() {
    let test = "lines_are_known_through_both_generators";
    if !common::can_compile(test) {
        return;
    }
    for codegen in [Codegen::Rustc, Codegen::Nvvm] {
        let shaders = Shaders::new(GOLDEN).codegen(codegen);
        let build = |lines| shaders.clone().line_info(lines).compile_in(common::area());
        let built = match build(true) {
            Err(Error::NoNvvm(reason)) => {
                eprintln!("{test}: not run, no libNVVM: {reason}");
                continue;
            }
            built => built.expect("it compiles"),
        };
        let source = with_source(&built.text, |name| name.contains("Golden_shade")).expect("lines are known");
        assert!(source.contains("typed/src/lib.rs:"), "{codegen:?}: {source}");
        let count = |text: &str| programs(text).iter().map(|program| program.instructions()).collect::<Vec<_>>();
        assert_eq!(count(&built.text), count(&build(false).expect("it compiles").text), "{codegen:?}");
    }
}

#[test]
fn the_command_puts_two_builds_side_by_side() {
    let nvcc = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/inspect/tests/nvcc.ptx");
    let rustc = nvcc.with_file_name("rustc.ptx");
    let run = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_cargo-optix"));
        let output = command.arg("inspect").arg("--ptx").arg(&rustc).args(more).output().expect("it runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).expect("text")
    };
    let compared = ["--compare", &nvcc.to_string_lossy()];
    let table = run(&compared);
    assert!(table.contains("__closesthit__Tracer_lambert_Radiance_7f36cb79 : __closesthit__lambert"), "{table}");
    assert!(table.contains("record loads               2       2   1.000"), "{table}");
    let table = run(&[]);
    assert!(table.lines().any(|line| line.trim_end().ends_with("_optix_get_sbt_data_ptr_64")), "{table}");

    let json = Json::parse(&run(&["--format", "json", compared[0], compared[1]])).expect("valid JSON");
    let program = &json.get("programs").items()[0];
    assert_eq!(program.get("figures").get("instructions").number(), Some(15));
    assert_eq!(program.get("other").get("calls").get("_Z4slowf").number(), Some(1));
}
