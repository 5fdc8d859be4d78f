//! A program with shaders, built by cargo as a user would.

mod common;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const MAIN: &str = "fn main() { print!(\"{}\", include_str!(env!(\"OPTIX_PTX_fixture_shaders\"))); }\n";

/// A host program around a copy of the fixture.
fn project(name: &str) -> PathBuf {
    let dir = common::folder(name);
    common::shader_crate(&dir);
    let manifest = format!(
        "[package]\nname = \"host\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n\
         [build-dependencies]\noptix-toolchain = {{ path = '{}', default-features = false }}\n\n\
         [workspace]\nexclude = [\"shaders\"]\n",
        env!("CARGO_MANIFEST_DIR")
    );
    fs::create_dir(dir.join("src")).expect("writable");
    fs::write(dir.join("Cargo.toml"), manifest).expect("writable");
    fs::write(dir.join("src/main.rs"), MAIN).expect("writable");
    fs::write(dir.join("build.rs"), "fn main() { optix_toolchain::shaders(\"shaders\") }\n").expect("writable");
    dir
}

/// Runs cargo in the project.
fn cargo(project: &Path, args: &[&str], device_compiler: Option<&str>) -> Output {
    let mut command = Command::new(env!("CARGO"));
    command
        .args(args)
        .arg("--offline")
        .current_dir(project)
        .env("CARGO_TARGET_DIR", common::projects())
        .env("CARGO_TERM_COLOR", "never")
        // A flag that the device compiler does not know: it must not get there.
        .env("RUSTFLAGS", "-Ctarget-feature=+sse4.2");
    match device_compiler {
        Some(rustc) => command.env("OPTIX_RUSTC", rustc),
        None => command.env_remove("OPTIX_RUSTC"),
    };
    command.output().expect("cargo runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// One test: its steps share a project, and cargo's lock on the target directory would serialise them anyway.
#[test]
fn a_program_with_shaders() {
    // Without a device compiler: a warning, and a program that runs.
    let dir = project("host");
    let run = cargo(&dir, &["run"], Some("none"));
    let (out, err) = (text(&run.stdout), text(&run.stderr));
    assert!(run.status.success(), "{err}");
    assert_eq!(out, "", "no PTX");
    assert_eq!(err.matches("warning:").count(), 1, "{err}");
    assert!(err.contains("shaders run on the CPU only"), "{err}");

    let again = cargo(&dir, &["build", "--verbose"], Some("none"));
    assert!(text(&again.stderr).contains("Fresh host"), "{}", text(&again.stderr));

    // A chosen compiler that can't do it is an error, not a warning.
    let run = cargo(&dir, &["build"], Some("/nonexistent/rustc"));
    assert!(!run.status.success());
    assert!(
        text(&run.stderr).contains("OPTIX_RUSTC can't compile shaders: /nonexistent/rustc"),
        "{}",
        text(&run.stderr)
    );

    if !common::can_compile("a_program_with_shaders") {
        return;
    }
    // With one: the program holds the PTX.
    let run = cargo(&dir, &["run"], None);
    assert!(run.status.success(), "{}", text(&run.stderr));
    assert!(text(&run.stdout).contains(".entry __raygen__camera"));
    assert!(!text(&run.stderr).contains("warning:"), "{}", text(&run.stderr));

    // Nothing changed: the build script does not run.
    let again = cargo(&dir, &["build", "--verbose"], None);
    assert!(text(&again.stderr).contains("Fresh host"), "{}", text(&again.stderr));

    // A source changed: it does.
    let shaders = dir.join("shaders");
    common::edit(&shaders, "__raygen__camera", "__raygen__lens");
    let run = cargo(&dir, &["run"], None);
    assert!(text(&run.stdout).contains(".entry __raygen__lens"), "{}", text(&run.stderr));

    // An error for the device only: rustc's diagnostics are shown, and the build fails.
    common::edit(&shaders, "let t: f32;", "let t: f32 = 1_u32;");
    let run = cargo(&dir, &["build"], None);
    let err = text(&run.stderr);
    assert!(!run.status.success());
    assert!(err.contains("error[E0308]: mismatched types") && err.contains("let t: f32 = 1_u32;"), "{err}");
    assert!(err.contains("compiling fixture-shaders for the device failed"), "{err}");

    // Put right, it builds.
    common::edit(&shaders, "let t: f32 = 1_u32;", "let t: f32;");
    assert!(cargo(&dir, &["build"], None).status.success());
}
