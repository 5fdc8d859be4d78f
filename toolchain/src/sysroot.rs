//! `core` for the device.
//!
//! Nobody distributes a `core` for `nvptx64-nvidia-cuda`, so it is compiled from the device compiler's sources, by
//! calling that compiler directly as the Linux kernel does. `cargo -Zbuild-std` would do it too, but resolves and
//! downloads all of `std`'s dependencies for that, needs an unstable cargo, and repeats it per set of flags.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::compiler::{DeviceCompiler, LIBRARY_PATH, TARGET};
use crate::error::{Doing, Error};
use crate::util;

/// `rustc` links every `no_std` crate to a crate of this name. Its functions would not reach the PTX (it never takes
/// part in link-time optimisation), so an empty one does; a symbol that would have come from it is reported as
/// unresolved by the check of the PTX.
const COMPILER_BUILTINS: &str = "#![no_std]\n#![feature(compiler_builtins)]\n#![compiler_builtins]\n";

/// Who compiles it, and for what.
pub(crate) struct Recipe<'a> {
    pub compiler: &'a DeviceCompiler,
    pub arch: &'a str,
    /// What selects a code generator other than `rustc`'s.
    pub generator: Option<Vec<String>>,
}

impl Recipe<'_> {
    /// The flags of the code generator.
    fn flags(&self) -> Vec<String> {
        match &self.generator {
            // The machine code of an rlib is never used, since everything is optimised together at the end: leave it
            // out, and optimise in parallel.
            None => {
                let cpu = format!("-Ctarget-cpu={}", self.arch);
                vec!["-Clinker-plugin-lto".into(), "-Ccodegen-units=16".into(), cpu]
            }
            // Without optimisation over crates, panics keep their messages unless `core` has none.
            Some(flags) => [flags.as_slice(), &["--cfg=feature=\"panic_immediate_abort\"".into()]].concat(),
        }
    }
}

/// The sysroot under `area`, compiled if it is not there yet. About 15 s on two cores, once.
pub(crate) fn ensure(recipe: &Recipe<'_>, area: &Path, quiet: bool) -> Result<PathBuf, Error> {
    let &Recipe { compiler, arch, .. } = recipe;
    let flags = recipe.flags();
    // The architecture is part of it: LLVM does not inline between functions of different target CPUs.
    let made_by = [compiler.version.as_str(), arch].into_iter().chain(flags.iter().map(String::as_str));
    let name = format!("sysroot-{}", util::hash(made_by));
    let sysroot = area.join(&name);
    if sysroot.is_dir() {
        return Ok(sysroot);
    }
    let _lock = util::lock(&area.join(format!("{name}.lock")))?;
    if sysroot.is_dir() {
        return Ok(sysroot);
    }
    if !quiet {
        eprintln!("   Compiling core for {TARGET} {arch} (once, about 15 s)");
    }
    // Complete or absent: it is made under another name and renamed.
    let unfinished = area.join(format!("{name}.part"));
    let libraries = unfinished.join("lib/rustlib").join(TARGET).join("lib");
    if unfinished.exists() {
        fs::remove_dir_all(&unfinished).doing(|| format!("cannot remove {}", unfinished.display()))?;
    }
    util::create_dir(&libraries)?;
    let builtins = unfinished.join("compiler_builtins.rs");
    util::write_if_changed(&builtins, COMPILER_BUILTINS)?;
    let core = compiler.library.join("core/src/lib.rs");
    let edition = compiler.core_edition()?;
    for (name, source) in [("core", &core), ("compiler_builtins", &builtins)] {
        let mut command = Command::new(&compiler.rustc);
        if recipe.generator.is_none() {
            command.env_remove(LIBRARY_PATH);
        }
        let status = command
            .args(["--crate-name", name, "--crate-type", "rlib", "--edition", &edition, "--target", TARGET])
            .args(["--cap-lints", "allow", "-Cpanic=abort", "-Copt-level=3", "-Cmetadata=optix"])
            .args(&flags)
            .arg("-Zforce-unstable-if-unmarked")
            .arg("--sysroot")
            .arg(&unfinished)
            .arg("--out-dir")
            .arg(&libraries)
            .arg(source)
            .env("RUSTC_BOOTSTRAP", "1")
            .status()
            .doing(|| format!("cannot run {}", compiler.rustc.display()))?;
        if !status.success() {
            return Err(Error::Step { doing: format!("compiling `{name}` for {TARGET}"), status });
        }
    }
    fs::rename(&unfinished, &sysroot).doing(|| format!("cannot rename {}", unfinished.display()))?;
    Ok(sysroot)
}
