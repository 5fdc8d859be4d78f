//! The package around a shader crate.
//!
//! A device build needs a profile, a lock file and a patch of its own. Writing those into the user's manifest is out
//! of the question, so a small package depends on the shader crate by path and re-exports it. Entry points and
//! `global_asm!` of the shader crate, and of what it depends on, reach the PTX through link-time optimisation. It also has
//! the allocator that `rustc` expects of a final crate, although there is no heap.

use std::path::PathBuf;

use crate::error::Error;
use crate::libm::PatchedLibm;
use crate::metadata::Package;
use crate::options::{Codegen, Shaders};
use crate::util::{toml_string, write_if_changed};

/// The profile of device builds. It has a name of its own, because cargo configuration files may change `release`.
pub(crate) const PROFILE: &str = "optix";

const HEAP: &str = include_str!("../templates/heap.rs");

/// The symbol that is left in the PTX where a program asks for memory.
pub(crate) const NO_HEAP: &str = "__optix_no_heap";

/// A wrapper package on disk.
pub(crate) struct Wrapper {
    /// Its folder.
    pub dir: PathBuf,
    /// Its library's name, which names the artifacts.
    pub library: String,
}

impl Wrapper {
    /// Writes the package to `dir`, leaving what is already as it should be.
    pub fn write(
        dir: PathBuf,
        shaders: &Shaders,
        package: &Package,
        libm: Option<&PatchedLibm>,
    ) -> Result<Self, Error> {
        let library = format!("optix_ptx_{}_{}", package.name.replace('-', "_"), &shaders.key(package.dir())[..8]);
        let user_library = package.library.as_deref().ok_or_else(|| Error::NotAShaderCrate {
            path: package.dir().to_path_buf(),
            reason: "it has no library; its code belongs into src/lib.rs".into(),
        })?;
        write_if_changed(&dir.join("Cargo.toml"), &manifest(&library, shaders, package, libm))?;
        // rustc_codegen_nvvm, which does not optimise over crates, would keep a heap that nobody uses.
        let heap = if shaders.codegen == Codegen::RustCuda { "" } else { HEAP };
        let library_source = format!("#![no_std]\n#![allow(unused_imports)]\npub use {user_library}::*;\n{heap}");
        write_if_changed(&dir.join("src/lib.rs"), &library_source)?;
        Ok(Self { dir, library })
    }
}

/// The manifest's table for the dependency on the shader crate.
pub(crate) fn dependency(shaders: &Shaders, package: &Package) -> String {
    let features: Vec<String> = shaders.features.iter().map(|feature| toml_string(feature)).collect();
    format!(
        "[dependencies.{dependency}]\n\
         path = {dir}\n\
         default-features = {default_features}\n\
         features = [{features}]\n",
        dependency = toml_string(&package.name),
        dir = toml_string(&package.dir().to_string_lossy()),
        default_features = shaders.default_features,
        features = features.join(", "),
    )
}

/// How proc macros and build scripts are compiled: in little time.
pub(crate) const BUILD_OVERRIDE: [&str; 3] = ["opt-level = 0", "codegen-units = 16", "strip = false"];

/// The manifest's table for the profile. Packages that share a folder for builds share proc macros if it is the same.
pub(crate) fn profile(shaders: &Shaders) -> String {
    format!(
        "[profile.{PROFILE}]\n\
         inherits = \"release\"\n\
         opt-level = 3\n\
         lto = \"fat\"\n\
         codegen-units = 1\n\
         panic = \"abort\"\n\
         debug = {debug}\n\
         strip = false\n\
         overflow-checks = {checks}\n\
         debug-assertions = {checks}\n\
         incremental = false\n\n\
         [profile.{PROFILE}.build-override]\n\
         {build_override}\n",
        build_override = BUILD_OVERRIDE.join("\n"),
        debug = if shaders.line_info { "\"line-directives-only\"" } else { "false" },
        checks = shaders.checks.unwrap_or(false),
    )
}

fn manifest(library: &str, shaders: &Shaders, package: &Package, libm: Option<&PatchedLibm>) -> String {
    let mut text = format!(
        "# Written by optix-toolchain; see its `wrapper` module.\n\
         [package]\n\
         name = {name}\n\
         version = \"0.0.0\"\n\
         edition = \"2024\"\n\
         publish = false\n\n\
         [lib]\n\
         crate-type = [\"staticlib\"]\n\n\
         {dependency}\n\
         {profile}\n\
         [workspace]\n",
        name = toml_string(library),
        dependency = dependency(shaders, package),
        profile = profile(shaders),
    );
    if let Some(libm) = libm {
        text.push_str(&format!(
            "\n[patch.crates-io]\nlibm = {{ path = {} }}\n",
            toml_string(&libm.dir.to_string_lossy())
        ));
    }
    text
}
