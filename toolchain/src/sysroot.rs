//! `core` and `alloc` for the device.
//!
//! Nobody distributes them for `nvptx64-nvidia-cuda`, so they are compiled from the device compiler's sources, by
//! calling that compiler directly as the Linux kernel does. `cargo -Zbuild-std` would do it too, but resolves and
//! downloads all of `std`'s dependencies for that, needs an unstable cargo, and repeats it per target directory.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::cache::cache;
use crate::compiler::{DeviceCompiler, LIBRARY_PATH, TARGET};
use crate::error::{Doing, Error};
use crate::util;

/// Options of every crate of a device build: a panic becomes a trap, and its message is not even formatted.
pub(crate) const PANIC: [&str; 2] = ["-Zunstable-options", "-Cpanic=immediate-abort"];

/// How the crates of the sysroot are compiled by any code generator.
const FLAGS: [&str; 5] =
    ["--cap-lints=allow", "-Cpanic=abort", "-Copt-level=3", "-Cmetadata=optix", "-Zforce-unstable-if-unmarked"];

/// `rustc` links every `no_std` crate to `compiler_builtins`. Its functions could not reach the PTX, because it never
/// takes part in link-time optimisation, so an empty one is enough. If the PTX uses a symbol of the real one, the check
/// of the PTX reports it as unresolved.
const COMPILER_BUILTINS: &str = "#![no_std]\n#![feature(compiler_builtins)]\n#![compiler_builtins]\n";

const ALLOC: &str = "liballoc.rlib";

/// The file that says which compiler made a sysroot: its path, then its version.
const MADE_BY: &str = "made-by";

/// The device's library crates for one compiler, architecture and set of flags.
#[derive(Clone, Debug)]
pub(crate) struct Sysroot {
    /// For `--sysroot`.
    pub path: PathBuf,
    compiler: DeviceCompiler,
    arch: String,
    flags: Vec<String>,
    /// Whether the code generator is `rustc`'s own.
    is_plain: bool,
    quiet: bool,
}

impl Sysroot {
    /// Where the sysroot is or will be: in the user's cache, which all projects share, or in `area` if the cache can't
    /// be written. `generator` is the key of a code generator other than `rustc`'s.
    pub fn new(
        compiler: &DeviceCompiler,
        arch: &str,
        generator: Option<Vec<String>>,
        area: &Path,
        quiet: bool,
    ) -> Self {
        let is_plain = generator.is_none();
        let mut flags: Vec<String> = FLAGS.map(String::from).into();
        match generator {
            // The machine code of an rlib is never used, since everything is optimised together at the end: leave it
            // out, and optimise in parallel.
            None => {
                flags.extend([
                    "-Clinker-plugin-lto".into(),
                    "-Ccodegen-units=16".into(),
                    format!("-Ctarget-cpu={arch}"),
                ]);
                flags.extend(PANIC.map(String::from));
            }
            // The nightly that the generator is for has this feature of `core` in place of `-Cpanic=immediate-abort`.
            Some(generator) => {
                flags.extend(generator);
                flags.push("--cfg=feature=\"panic_immediate_abort\"".into());
            }
        }
        // The architecture is part of it: LLVM does not inline between functions of different target CPUs.
        let made_of = [compiler.version.as_str(), arch, COMPILER_BUILTINS];
        let name = format!("sysroot-{}", util::hash(made_of.into_iter().chain(flags.iter().map(String::as_str))));
        let shared = cache().filter(|cache| cache.join(&name).is_dir() || util::is_writable(cache));
        let path = shared.unwrap_or_else(|| area.to_path_buf()).join(name);
        Self { path, compiler: compiler.clone(), arch: arch.to_string(), flags, is_plain, quiet }
    }

    /// Whether `core` is there.
    pub fn is_made(&self) -> bool {
        self.path.is_dir()
    }

    /// Compiles `core`, unless that was done before. It takes 18 s of one processor.
    pub fn make(&self) -> Result<(), Error> {
        if self.is_made() {
            return Ok(());
        }
        let _lock = self.lock()?;
        if self.is_made() {
            return Ok(());
        }
        // It is made under another name and then renamed, so that it is either complete or absent.
        let unfinished = self.path.with_extension("part");
        if unfinished.exists() {
            fs::remove_dir_all(&unfinished).doing(|| format!("cannot remove {}", unfinished.display()))?;
        }
        let builtins = unfinished.join("compiler_builtins.rs");
        util::write_if_changed(&builtins, COMPILER_BUILTINS)?;
        util::write_if_changed(&unfinished.join(MADE_BY), &self.made_by())?;
        self.say("core");
        self.compile("core", &self.compiler.library.join("core/src/lib.rs"), &unfinished, &libraries(&unfinished))?;
        self.compile("compiler_builtins", &builtins, &unfinished, &libraries(&unfinished))?;
        fs::rename(&unfinished, &self.path).doing(|| format!("cannot rename {}", unfinished.display()))?;
        self.remove_outdated();
        Ok(())
    }

    /// Whether `alloc` is there too.
    pub fn has_alloc(&self) -> bool {
        libraries(&self.path).join(ALLOC).is_file()
    }

    /// Compiles `alloc`, unless that was done before. It takes 5 s of one processor, and is done only for crates that
    /// use `alloc`.
    pub fn make_alloc(&self) -> Result<(), Error> {
        let _lock = self.lock()?;
        if self.has_alloc() {
            return Ok(());
        }
        let unfinished = self.path.join("part");
        self.say("alloc");
        self.compile("alloc", &self.compiler.library.join("alloc/src/lib.rs"), &self.path, &unfinished)?;
        let from = unfinished.join(ALLOC);
        fs::rename(&from, libraries(&self.path).join(ALLOC)).doing(|| format!("cannot rename {}", from.display()))
    }

    fn lock(&self) -> Result<fs::File, Error> {
        util::lock(&self.path.with_extension("lock"))
    }

    fn say(&self, name: &str) {
        if !self.quiet {
            eprintln!("   Compiling {name} for {TARGET} {} (once)", self.arch);
        }
    }

    fn compile(&self, name: &str, source: &Path, sysroot: &Path, out_dir: &Path) -> Result<(), Error> {
        util::create_dir(out_dir)?;
        let edition = self.compiler.core_edition()?;
        let mut command = Command::new(&self.compiler.rustc);
        if self.is_plain {
            command.env_remove(LIBRARY_PATH);
        }
        let status = command
            .args(["--crate-name", name, "--crate-type", "rlib", "--edition", &edition, "--target", TARGET])
            .args(&self.flags)
            .arg("--sysroot")
            .arg(sysroot)
            .arg("--out-dir")
            .arg(out_dir)
            .arg(source)
            .env("RUSTC_BOOTSTRAP", "1")
            .status()
            .doing(|| format!("cannot run {}", self.compiler.rustc.display()))?;
        if status.success() {
            Ok(())
        } else {
            Err(Error::Step { doing: format!("compiling `{name}` for {TARGET}"), status })
        }
    }

    fn made_by(&self) -> String {
        format!("{}\n{}", self.compiler.rustc.display(), self.compiler.version)
    }

    /// Removes sysroots that nobody can use any more: of compilers that are gone or have another version now.
    fn remove_outdated(&self) {
        let entries = self.path.parent().and_then(|folder| fs::read_dir(folder).ok());
        for folder in entries.into_iter().flatten().flatten().map(|entry| entry.path()) {
            let Ok(made_by) = fs::read_to_string(folder.join(MADE_BY)) else {
                continue;
            };
            let rustc = Path::new(made_by.lines().next().unwrap_or_default());
            let is_gone = rustc.is_absolute() && !rustc.is_file();
            if is_gone || (rustc == self.compiler.rustc && made_by != self.made_by()) {
                // A sysroot that can't be removed does no harm, so errors are ignored.
                let _ = fs::remove_dir_all(folder);
            }
        }
    }
}

/// Where `rustc` looks for libraries of the device.
fn libraries(sysroot: &Path) -> PathBuf {
    sysroot.join("lib/rustlib").join(TARGET).join("lib")
}
