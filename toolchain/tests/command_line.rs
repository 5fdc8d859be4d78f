//! The options of `cargo optix` that say how cargo finds and compiles packages.

mod common;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const SHADERS: &str = r#"#![no_std]

macro_rules! entry {
    ($name:ident) => {
        #[unsafe(no_mangle)]
        pub unsafe extern "ptx-kernel" fn $name() {
            let x: u32;
            unsafe { core::arch::asm!("call ({}), _optix_get_launch_index_x, ();", out(reg32) x) };
            let value = x + 3;
            unsafe { core::arch::asm!("call _optix_set_payload, ({}, {});", in(reg32) 0, in(reg32) value) };
        }
    };
}
entry!(__raygen__always);
#[cfg(feature = "usual")]
entry!(__raygen__usual);
#[cfg(feature = "own")]
entry!(__raygen__own);
#[cfg(feature = "shared")]
entry!(__raygen__shared);
"#;

const PANIC: &str = "\n#[panic_handler]\nfn panic(_: &core::panic::PanicInfo) -> ! {\n    loop {}\n}\n";

/// A workspace of two shader crates. None: this machine can't compile them, and the test `name` does not run.
fn workspace(name: &str) -> Option<PathBuf> {
    let dir = common::can_compile(name).then(|| common::folder(&format!("command-line-{name}")))?;
    let manifest = "[workspace]\nresolver = \"3\"\nmembers = [\"first\", \"second\"]\n\n[profile.careful]\ninherits = \
                    \"release\"\noverflow-checks = true\n";
    fs::write(dir.join("Cargo.toml"), manifest).expect("writable");
    for (name, features) in [("first", "own = []\n"), ("second", "")] {
        let manifest = format!(
            "[package]\nname = \"{name}\"\nversion = \"1.0.0\"\nedition = \"2024\"\n\n[package.metadata.optix]\nshaders = true\n\n\
             [features]\ndefault = [\"usual\"]\nusual = []\nshared = []\n{features}"
        );
        fs::create_dir_all(dir.join(name).join("src")).expect("writable");
        fs::write(dir.join(name).join("Cargo.toml"), manifest).expect("writable");
        fs::write(dir.join(name).join("src/lib.rs"), format!("{SHADERS}{PANIC}")).expect("writable");
    }
    Some(dir)
}

/// What `cargo optix build` writes and says, with these arguments; the message if it fails.
fn build(dir: &Path, args: &[&str]) -> Result<String, String> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cargo-optix"));
    command.args(["optix", "build"]).args(args).current_dir(dir).env("CARGO_TARGET_DIR", common::projects());
    let output = command.env("CARGO_TERM_COLOR", "never").output().expect("it runs");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    if output.status.success() { Ok(text(&output.stdout)) } else { Err(text(&output.stderr)) }
}

/// The programs in what it says, by crate.
fn entries(said: &str) -> Vec<(String, Vec<String>)> {
    let mut crates: Vec<(String, Vec<String>)> = Vec::new();
    for line in said.lines() {
        match (line.trim().strip_prefix("__raygen__"), crates.last_mut()) {
            (Some(name), Some((_, entries))) => entries.push(name.to_string()),
            _ => {
                let (path, _) = line.split_once(".ptx").expect("the path of the PTX");
                crates.push((path.rsplit('/').next().unwrap_or_default().to_string(), Vec::new()));
            }
        }
    }
    crates.iter_mut().for_each(|(_, entries)| entries.sort());
    crates
}

/// Whether the addition in the PTX of the crate `first` is checked.
fn is_checked() -> bool {
    fs::read_to_string(common::projects().join("optix/ptx/first.ptx")).expect("it is there").contains("trap;")
}

#[test]
fn features() {
    let Some(dir) = workspace("features") else { return };
    let found = |args: &[&str]| entries(&build(&dir, args).expect("it builds"));
    let expected = |first: &[&str], second: &[&str]| {
        let list = |names: &[&str]| names.iter().map(ToString::to_string).collect::<Vec<_>>();
        vec![("first".to_string(), list(first)), ("second".to_string(), list(second))]
    };
    assert_eq!(found(&[]), expected(&["always", "usual"], &["always", "usual"]));
    assert_eq!(found(&["--no-default-features"]), expected(&["always"], &["always"]));
    assert_eq!(
        found(&["--features", "own,shared"]),
        expected(&["always", "own", "shared", "usual"], &["always", "shared", "usual"])
    );
    assert_eq!(
        found(&["--no-default-features", "-F", "own second/shared"]),
        expected(&["always", "own"], &["always", "shared"])
    );
    let error = build(&dir, &["--crate", "second", "--features", "own"]).expect_err("it has none");
    assert!(error.contains("no shader crate here has a feature `own`"), "{error}");
}

#[test]
fn locked() {
    let Some(dir) = workspace("locked") else { return };
    let error = build(&dir, &["--locked"]).expect_err("there is no lock file");
    assert!(error.contains("Cargo.lock") && error.contains("--locked"), "{error}");
    assert!(!dir.join("Cargo.lock").exists());
    build(&dir, &[]).expect("it builds");
    build(&dir, &["--locked"]).expect("the lock file is right");
}

#[test]
fn offline() {
    let Some(dir) = workspace("offline") else { return };
    let manifest = dir.join("first/Cargo.toml");
    let text = fs::read_to_string(&manifest).expect("readable");
    // A registry on this machine that is not there.
    let registry = "[dependencies]\nnowhere = { version = \"1\", registry = \"here\" }\n";
    fs::write(&manifest, format!("{text}\n{registry}")).expect("writable");
    let config = "registries.here.index=\"sparse+http://127.0.0.1:9/\"";
    let error = build(&dir, &["--crate", "first", "--config", config, "--offline"]).expect_err("no such package");
    assert!(error.contains("--offline"), "{error}");
}

#[test]
fn settings() {
    let Some(dir) = workspace("settings") else { return };
    build(&dir, &["--crate", "first"]).expect("it builds");
    assert!(!is_checked());
    build(&dir, &["--crate", "first", "--config", "profile.release.overflow-checks=true"]).expect("it builds");
    assert!(is_checked());
    build(&dir, &["--crate", "first"]).expect("it builds");
    assert!(!is_checked());
    // A file is found from where the command was given.
    fs::write(dir.join("second/mine.toml"), "[profile.release]\noverflow-checks = true\n").expect("writable");
    build(&dir.join("second"), &["--crate", "../first", "--config", "mine.toml"]).expect("it builds");
    assert!(is_checked());
}

#[test]
fn profiles() {
    let Some(dir) = workspace("profiles") else { return };
    for (profile, checked) in [("release", false), ("dev", true), ("careful", true)] {
        build(&dir, &["--crate", "first", "--profile", profile]).expect("it builds");
        assert_eq!(is_checked(), checked, "{profile}");
    }
    let error = build(&dir, &["--crate", "first", "--profile", "none"]).expect_err("there is none");
    assert!(error.contains("profile `none` is not defined"), "{error}");
}
