//! Builds and runs the program that prints what the host computes from a shader crate's pipelines.
//!
//! The PTX is compared with what a host program computes from the same declarations. So such a program is generated,
//! which depends on the shader crate by path. A pipeline need not be public for that: if `--cfg optix_facts` is set,
//! `pipeline!` exports its description under a symbol that ends like the names of the pipeline's entries.
//!
//! The device compiler compiles it for the host, in the folder of the device build, where the proc macros are compiled
//! already.

use std::collections::BTreeSet;

use super::facts::{self, Pipeline};
use crate::cargo;
use crate::device_build::Session;
use crate::error::Error;
use crate::lock;
use crate::metadata::Package;
use crate::original::taken_from;
use crate::outer;
use crate::util::write_if_changed;
use crate::wrapper::{PROFILE, dependency, profile, root};

const MAIN: &str = include_str!("../../templates/facts/main.rs");
const DEVICE_CRATE: &str = "optix-device-rs";

/// The pipelines that these entries belong to. Entries that no `pipeline!` made are ignored.
pub(super) fn pipelines(session: &Session<'_>, entries: &[String]) -> Result<Vec<Pipeline>, Error> {
    let places: BTreeSet<&str> = entries.iter().filter_map(|entry| place(entry)).collect();
    let device_crate = session.graph.packages.iter().find(|package| package.name == DEVICE_CRATE);
    let Some(device_crate) = device_crate.filter(|_| !places.is_empty()) else {
        return Ok(Vec::new());
    };
    let dir = session.own.join("facts");
    write_if_changed(&dir.join("Cargo.toml"), &manifest(session, device_crate))?;
    write_if_changed(&dir.join("src/main.rs"), &source(session, &places))?;
    lock::seed(&dir, &session.locked()?)?;

    let mut command = session.place.cargo("run", &dir.join("Cargo.toml"));
    command.args(["--quiet", "--profile", PROFILE, "--target", session.compiler.host()?]);
    command.arg("--target-dir").arg(session.target_dir());
    let flags = ["--cfg", "optix_facts"].map(String::from).into_iter().chain(outer::flags());
    session.by_device_compiler(&mut command).env("CARGO_ENCODED_RUSTFLAGS", flags.collect::<Vec<_>>().join("\x1f"));
    let text = cargo::read(&mut command, &format!("reading the pipelines of {}", session.package.name))?;
    facts::parse(&text)
}

/// The eight hexadecimal digits that an entry of `pipeline!` ends with.
fn place(entry: &str) -> Option<&str> {
    let (_, place) = entry.rsplit_once('_')?;
    let is_digit = |c: char| matches!(c, '0'..='9' | 'a'..='f');
    (place.len() == 8 && place.chars().all(is_digit)).then_some(place)
}

fn manifest(session: &Session<'_>, device_crate: &Package) -> String {
    format!(
        "# Written by optix-toolchain; see its `verify` module.\n\
         [package]\n\
         name = \"optix-facts-{}\"\n\
         version = \"0.0.0\"\n\
         edition = \"2024\"\n\
         publish = false\n\n\
         [dependencies]\n\
         {DEVICE_CRATE} = {{ {of_device_crate} }}\n\n\
         {dependency}\n\
         {profile}\n\
         {root}",
        // The program's name is unique, because builds share a folder, where programs with one name would overwrite
        // each other.
        session.own.file_name().unwrap_or_default().display(),
        dependency = dependency(&session.recipe, &session.package),
        of_device_crate = taken_from(device_crate),
        profile = profile(session.shaders, &session.recipe),
        root = root(&session.recipe, None),
    )
}

fn source(session: &Session<'_>, places: &BTreeSet<&str>) -> String {
    let library = session.package.library.as_deref().unwrap_or_default();
    let list = |text: &dyn Fn(&str) -> String| places.iter().map(|place| text(place)).collect::<String>();
    let declarations = list(&|place| format!("        safe fn __optix_facts_{place}() -> &'static D;\n"));
    let calls = list(&|place| format!("            __optix_facts_{place}(),\n"));
    // The crate is mentioned so that it gets linked.
    format!(
        "{MAIN}mod facts {{\n    extern crate r#{library} as _;\n    use ::optix_device_rs::host::PipelineDescription as D;\n\n    \
         unsafe extern \"Rust\" {{\n{declarations}    }}\n\n    pub fn all() -> Vec<&'static D> {{\n        \
         vec![\n{calls}        ]\n    }}\n}}\n"
    )
}

#[cfg(test)]
mod tests {
    use super::place;

    #[test]
    fn places_are_told_from_other_endings() {
        assert_eq!(place("__raygen__PathTracer_camera_1c5c38d3"), Some("1c5c38d3"));
        assert_eq!(place("__raygen__camera_by_hand"), None);
        assert_eq!(place("camera"), None);
    }
}
