//! What compiles for the host and not for the device: the device build says what to use.

mod common;

use std::fs;
use std::path::Path;
use std::process::Command;

const SHADERS: &str = r#"#![no_std]
use optix_device_rs::prelude::*;

pub fn of_f32(x: f32) -> f32 {
    x.powi(2) + x.ln_1p()
}

pub fn of_f64(x: f64) -> f64 {
    x.sqrt()
}

/// Another crate's functions are found first, such as those of `num_traits::Float`.
pub trait Float {
    fn powi(self, n: i32) -> Self;
}
impl Float for f64 {
    fn powi(self, n: i32) -> Self {
        if n == 0 { 1.0 } else { self }
    }
}
pub fn of_another_crate(x: f64) -> f64 {
    x.powi(2)
}
"#;

#[test]
fn a_function_that_only_the_host_has() {
    if !common::can_compile("a_function_that_only_the_host_has") {
        return;
    }
    let dir = common::folder("host-only");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a workspace");
    let manifest = format!(
        "[package]\nname = \"host-only\"\nversion = \"1.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n[package.metadata.optix]\n\
         shaders = true\n\n[dependencies]\noptix-device-rs = {{ path = {:?} }}\n",
        root.join("optix-device-rs")
    );
    fs::create_dir_all(dir.join("src")).expect("writable");
    fs::write(dir.join("Cargo.toml"), manifest).expect("writable");
    fs::write(dir.join("src/lib.rs"), SHADERS).expect("writable");
    // The workspace's versions.
    fs::copy(root.join("Cargo.lock"), dir.join("Cargo.lock")).expect("writable");
    let mut command = Command::new(env!("CARGO_BIN_EXE_cargo-optix"));
    command.args(["optix", "build"]).current_dir(&dir).env("CARGO_TARGET_DIR", common::projects());
    let output = command.output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success(), "{said}");
    for part in [
        "the device has no `powi`, though the host has",
        "`x.powf(2.0)`",
        "the device does not have this function of `f32`",
        "the device has no functions of `f64`",
        "`(x as f32).sqrt()`",
        "could not compile `host-only` (lib) due to 3 previous errors",
    ] {
        assert!(said.contains(part), "{part} is not in:\n{said}");
    }
}
