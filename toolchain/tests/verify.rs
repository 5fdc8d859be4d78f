//! The workspace's shader crates keep their contracts; a damaged one does not.

mod common;

use std::fs;
use std::path::Path;

use optix_toolchain::Shaders;
use optix_toolchain::verify::{Kind, Level, Rule, Verified, check};

fn verified(path: &str) -> Verified {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
    Shaders::new(path).verify_in(common::area(), &[]).expect("it compiles")
}

#[test]
fn the_workspaces_shaders_are_sound() {
    if !common::can_compile("the_workspaces_shaders_are_sound") {
        return;
    }
    let mut kinds = Vec::new();
    for (path, pipeline) in [
        ("examples/path-tracer/shaders", "PathTracer"),
        ("tests/shaders", "Probe"),
        ("tests/golden/typed", "Golden"),
        ("tests/renamed", "Flat"),
    ] {
        let verified = verified(path);
        assert!(verified.findings.is_empty(), "{path}: {:#?}", verified.findings);
        assert!(verified.pipelines.iter().any(|found| found.name == pipeline), "{path}: {:?}", verified.pipelines);
        let programs: usize = verified.pipelines.iter().map(|found| found.programs.len()).sum();
        assert_eq!(programs, verified.built.entries.len(), "{path}: each entry is compared");
        kinds.extend(verified.pipelines.iter().flat_map(|pipeline| &pipeline.programs).map(|program| program.kind));
    }
    // So what the macros call each kind is what is known here.
    for kind in Kind::ALL {
        assert!(kinds.contains(&kind), "no shader crate above has a program of the kind {kind:?}");
    }
}

#[test]
fn damage_to_real_ptx_is_found() {
    if !common::can_compile("damage_to_real_ptx_is_found") {
        return;
    }
    let Verified { built, pipelines, .. } = verified("examples/path-tracer/shaders");
    let rules = |text: &str| -> Vec<Rule> {
        let errors = check(text, &pipelines, &[]).into_iter().filter(|finding| finding.level == Level::Error);
        let mut rules: Vec<Rule> = errors.map(|finding| finding.rule).collect();
        rules.dedup();
        rules
    };
    // The host binds a field that the device reads from somewhere else.
    let mut other_layout = pipelines.clone();
    let frame = &mut other_layout[0].params;
    let bound = frame.fields.iter_mut().find(|field| field.bound).expect("`max_bounces`");
    bound.offset += 8;
    let found = check(&built.text, &other_layout, &[]);
    assert!(
        found.iter().any(|finding| finding.rule == Rule::ParamsLoad && finding.item.contains("`camera::camera`")),
        "{found:?}"
    );

    let symbol = &pipelines[0].params.symbol;
    let declared = format!("{symbol}[{}]", pipelines[0].params.size);
    assert_eq!(rules(&built.text.replace(&declared, &format!("{symbol}[8]"))), [Rule::ParamsSymbol]);
    assert_eq!(rules(&built.text.replace(&pipelines[0].layouts, "nobodys_layouts")), [Rule::Layout]);
    assert_eq!(rules(&built.text.replace("_optix_trace_typed_32", "_optix_trace_32")), [Rule::Trace]);
    let entry = &pipelines[0].programs[0].entry;
    assert_eq!(rules(&built.text.replace(entry.as_str(), "__raygen__nobody")), [Rule::Entry]);
}

#[test]
fn types_that_differ_on_the_device_are_named() {
    if !common::can_compile("types_that_differ_on_the_device_are_named") {
        return;
    }
    let (shaders, workspace) = (common::folder("layouts"), Path::new(env!("CARGO_MANIFEST_DIR")).join(".."));
    let manifest = format!(
        "[package]\nname = \"layouts\"\nedition = \"2024\"\n[dependencies]\noptix-device-rs.path = {:?}\n[workspace]\n",
        workspace.join("optix-device-rs")
    );
    fs::create_dir(shaders.join("src")).expect("writable");
    fs::write(shaders.join("Cargo.toml"), manifest).expect("writable");
    fs::write(shaders.join("src/lib.rs"), include_str!("fixture/layouts.rs")).expect("writable");
    fs::copy(workspace.join("Cargo.lock"), shaders.join("Cargo.lock")).expect("the versions that are downloaded");
    let verified = Shaders::new(&shaders).verify_in(common::area(), &[]).expect("it compiles");
    let layouts = verified.findings.iter().filter(|finding| finding.rule == Rule::Layout);
    let mut found: Vec<String> = layouts.map(|finding| format!("{}: {}", finding.item, finding.message)).collect();
    found.sort();
    let other = |what: &str| format!("{what} of its ");
    let expected = [
        other("attributes `BallHit` of `Flat`:"),
        other("exception `Fault` of `Flat`:"),
        other("launch parameters `Frame` of `Flat`:"),
        "payload `Radiance` of `Flat`: the PTX has 4 words of it, the host 1".into(),
        other("record `Paint` of `Flat`:"),
        "record `Sky` of `Flat`: the PTX has 32 bytes of it, the host 8".into(),
        other("record `Wood` of `Flat`:"),
        other("signature of callable `wood` of `Flat`:"),
    ];
    assert_eq!(found.len(), expected.len(), "{found:#?}");
    for (found, expected) in found.iter().zip(&expected) {
        assert!(found.starts_with(expected), "{found}, not {expected}");
    }
}
