//! The generated package around a shader crate.
//!
//! A device build needs its own profile, lock file and patches. It can't write those into the user's manifest, so it
//! generates a small package that depends on the shader crate by path and links it. Entry points and `global_asm!` of
//! the shader crate, and of its dependencies, reach the PTX through link-time optimisation. The package also has the
//! allocator that `rustc` expects of a final crate, although the device has no heap.

use std::path::PathBuf;

use crate::error::{Error, Lacking};
use crate::libm::PatchedLibm;
use crate::metadata::Package;
use crate::options::{Codegen, Shaders};
use crate::original::{Patch, patch_tables};
use crate::units::Checks;
use crate::util::{toml_string, write_if_changed};

/// The profile of device builds. It has a name of its own, because cargo configuration files may change `release`.
pub(crate) const PROFILE: &str = "optix";

const HEAP: &str = include_str!("../templates/heap.rs");

/// The undefined symbol that is left in the PTX if a program allocates memory.
pub(crate) const NO_HEAP: &str = "__optix_no_heap";

/// What a generated package has to contain, so that the shader crate is compiled as in the user's own build.
pub(crate) struct Recipe {
    /// The shader crate's features that are on.
    pub features: Vec<String>,
    /// The packages that do not come from where manifests say, and where they come from.
    pub patches: Vec<Patch>,
    /// The version of cargo's feature resolver.
    pub resolver: &'static str,
    /// The run-time checks of the shader crate.
    pub checks: Checks,
    /// Packages such as `glam@0.34.3` that have other checks, with those.
    pub other_checks: Vec<(String, Checks)>,
}

/// A wrapper package on disk.
pub(crate) struct Wrapper {
    /// Its folder.
    pub dir: PathBuf,
    /// Its library's name, which names the artifacts.
    pub library: String,
}

impl Wrapper {
    /// Writes the package to `dir`, leaving what is already as it should be. `key` is a part of its name.
    pub fn write(
        dir: PathBuf,
        shaders: &Shaders,
        package: &Package,
        recipe: &Recipe,
        key: &str,
        libm: Option<&PatchedLibm>,
    ) -> Result<Self, Error> {
        let library = format!("optix_ptx_{}_{}", package.name.replace('-', "_"), &key[..8]);
        let user_library = package
            .library
            .as_deref()
            .ok_or_else(|| Error::NotAShaderCrate { path: package.dir().to_path_buf(), lacks: Lacking::Library })?;
        write_if_changed(&dir.join("Cargo.toml"), &manifest(&library, shaders, package, recipe, libm))?;
        // rustc_codegen_nvvm does not optimise across crates, so it would keep the allocator even if nobody uses it.
        let heap = if shaders.codegen == Codegen::RustCuda { "" } else { HEAP };
        // The crate is imported as `_`, because its library may have any name.
        let library_source = format!("#![no_std]\nextern crate r#{user_library} as _;\n{heap}");
        write_if_changed(&dir.join("src/lib.rs"), &library_source)?;
        Ok(Self { dir, library })
    }

    /// Its manifest.
    pub fn manifest(&self) -> PathBuf {
        self.dir.join("Cargo.toml")
    }
}

/// The manifest's table for the dependency on the shader crate.
pub(crate) fn dependency(recipe: &Recipe, package: &Package) -> String {
    let features: Vec<String> = recipe.features.iter().map(|feature| toml_string(feature)).collect();
    format!(
        "[dependencies.{dependency}]\n\
         path = {dir}\n\
         default-features = false\n\
         features = [{features}]\n",
        dependency = toml_string(&package.name),
        dir = toml_string(&package.dir().to_string_lossy()),
        features = features.join(", "),
    )
}

/// Settings for proc macros and build scripts, which are compiled as fast as possible.
pub(crate) const BUILD_OVERRIDE: [&str; 3] = ["opt-level = 0", "codegen-units = 16", "strip = false"];

/// The manifest's table for the profile. Packages that share a build folder also share the compiled proc macros, if
/// this table is the same.
pub(crate) fn profile(shaders: &Shaders, recipe: &Recipe) -> String {
    let Checks { overflow, assertions } = recipe.checks;
    let mut text = format!(
        "[profile.{PROFILE}]\n\
         inherits = \"release\"\n\
         opt-level = 3\n\
         lto = \"fat\"\n\
         codegen-units = 1\n\
         panic = \"abort\"\n\
         debug = {debug}\n\
         strip = false\n\
         overflow-checks = {overflow}\n\
         debug-assertions = {assertions}\n\
         incremental = false\n\n\
         [profile.{PROFILE}.build-override]\n\
         {build_override}\n",
        build_override = BUILD_OVERRIDE.join("\n"),
        debug = if shaders.line_info { "\"line-directives-only\"" } else { "false" },
    );
    for (package, Checks { overflow, assertions }) in &recipe.other_checks {
        text.push_str(&format!(
            "\n[profile.{PROFILE}.package.{}]\noverflow-checks = {overflow}\ndebug-assertions = {assertions}\n",
            toml_string(package)
        ));
    }
    text
}

/// The end of a manifest: what the root manifest of a workspace would contain.
pub(crate) fn root(recipe: &Recipe, libm: Option<&PatchedLibm>) -> String {
    let patches = patch_tables(&recipe.patches, libm.map(|libm| libm.dir.as_path()));
    format!("[workspace]\nresolver = {}\n{patches}", toml_string(recipe.resolver))
}

fn manifest(
    library: &str,
    shaders: &Shaders,
    package: &Package,
    recipe: &Recipe,
    libm: Option<&PatchedLibm>,
) -> String {
    format!(
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
         {root}",
        name = toml_string(library),
        dependency = dependency(recipe, package),
        profile = profile(shaders, recipe),
        root = root(recipe, libm),
    )
}
