//! The package around a shader crate.
//!
//! A device build needs a profile, a lock file and a patch of its own. Writing those into the user's manifest is out
//! of the question, so a package of one line depends on the shader crate by path and re-exports it. Entry points and
//! `global_asm!` of the shader crate, and of what it depends on, reach the PTX through link-time optimisation.

use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::libm::PatchedLibm;
use crate::metadata::Package;
use crate::options::Shaders;
use crate::util::{toml_string, write_if_changed};

/// The profile of device builds. It has a name of its own, because cargo configuration files may change `release`.
pub(crate) const PROFILE: &str = "optix";

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
        write_if_changed(&dir.join("src/lib.rs"), &format!("#![no_std]\npub use {user_library}::*;\n"))?;
        Ok(Self { dir, library })
    }
}

fn manifest(library: &str, shaders: &Shaders, package: &Package, libm: Option<&PatchedLibm>) -> String {
    let path = |dir: &Path| toml_string(&dir.to_string_lossy());
    let features: Vec<String> = shaders.features.iter().map(|feature| toml_string(feature)).collect();
    let mut text = format!(
        "# Written by optix-toolchain; see its `wrapper` module.\n\
         [package]\n\
         name = {name}\n\
         version = \"0.0.0\"\n\
         edition = \"2024\"\n\
         publish = false\n\n\
         [lib]\n\
         crate-type = [\"staticlib\"]\n\n\
         [dependencies.{dependency}]\n\
         path = {dir}\n\
         default-features = {default_features}\n\
         features = [{features}]\n\n\
         [profile.{PROFILE}]\n\
         inherits = \"release\"\n\
         opt-level = 3\n\
         lto = \"fat\"\n\
         codegen-units = 1\n\
         panic = \"abort\"\n\
         debug = {debug}\n\
         strip = false\n\
         overflow-checks = false\n\
         debug-assertions = false\n\
         incremental = false\n\n\
         [workspace]\n",
        name = toml_string(library),
        dependency = toml_string(&package.name),
        dir = path(package.dir()),
        default_features = shaders.default_features,
        features = features.join(", "),
        debug = if shaders.line_info { "\"line-directives-only\"" } else { "false" },
    );
    if let Some(libm) = libm {
        text.push_str(&format!("\n[patch.crates-io]\nlibm = {{ path = {} }}\n", path(&libm.dir)));
    }
    text
}
