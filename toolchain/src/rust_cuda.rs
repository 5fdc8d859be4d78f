//! The third code generator: `rustc_codegen_nvvm` of the Rust-CUDA project, where a user has it.
//!
//! It is a library for one particular nightly `rustc`, which loads it in place of LLVM. It turns MIR into LLVM 7's IR
//! and calls libNVVM itself. The name of the compiler library that it is linked with tells which `rustc` it is for.

use std::fmt;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::compiler::{Candidate, DeviceCompiler, LIBRARY_PATH, Rejected, Release};
use crate::error::Error;
use crate::options::Shaders;
use crate::wrapper::PROFILE;

/// The environment variable that names the library.
pub const CHOICE: &str = "OPTIX_RUSTC_CODEGEN_NVVM";

/// What to install, for messages.
pub const INSTALL: &str = "build `rustc_codegen_nvvm` of https://github.com/Rust-GPU/Rust-CUDA, which needs the nightly of its \
    rust-toolchain.toml with the components rust-src, rustc-dev and llvm-tools-preview, LLVM 7 and a CUDA toolkit; then name \
    librustc_codegen_nvvm.so by OPTIX_RUSTC_CODEGEN_NVVM, or add its folder to LD_LIBRARY_PATH";

/// The release of the oldest nightly that the generator's options were read for.
const OLDEST: Release = Release { major: 1, minor: 90 };

/// The generator and the compiler that it is for.
#[derive(Clone, Debug)]
pub struct Backend {
    /// `librustc_codegen_nvvm.so`
    pub library: PathBuf,
    /// The `rustc` that loads it.
    pub compiler: DeviceCompiler,
}

/// Why the generator can't be used.
#[derive(Debug)]
#[non_exhaustive]
pub enum Unusable {
    /// It is not there.
    NotThere,
    /// It is there.
    Library {
        /// The library.
        library: PathBuf,
        /// What is wrong with it.
        why: WhyUnusable,
    },
}

/// What is wrong with a library of the generator.
#[derive(Debug)]
#[non_exhaustive]
pub enum WhyUnusable {
    /// It can't be read.
    Unreadable(std::io::Error),
    /// It is no library for a `rustc`.
    NotOfRustc,
    /// No installed toolchain is the one that it is for.
    NoCompiler {
        /// The library of the compiler that it is for.
        driver: String,
    },
    /// The compiler that it is for can't be used.
    Compiler(Rejected),
}

impl fmt::Display for Unusable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::Library { library, why } = self else { return f.write_str("it is not there") };
        write!(f, "{} ", library.display())?;
        match why {
            WhyUnusable::Unreadable(error) => write!(f, "can't be read: {error}"),
            WhyUnusable::NotOfRustc => f.write_str("is no library for a rustc"),
            WhyUnusable::NoCompiler { driver } => {
                write!(f, "is for a rustc with {driver}, which no installed toolchain has")
            }
            WhyUnusable::Compiler(rejected) => write!(f, "is for a compiler that can't be used: {rejected}"),
        }
    }
}

impl Backend {
    /// The one that `OPTIX_RUSTC_CODEGEN_NVVM` names, or else the first in the folders of `LD_LIBRARY_PATH`.
    ///
    /// ```no_run
    /// let backend = optix_toolchain::rust_cuda::Backend::find()?;
    /// println!("{} for {}", backend.library.display(), backend.compiler.rustc.display());
    /// # Ok::<(), optix_toolchain::Error>(())
    /// ```
    pub fn find() -> Result<Self, Error> {
        let library = library().ok_or(Error::NoRustCuda(Unusable::NotThere))?;
        Self::of(library)
    }

    /// The generator in a file.
    fn of(library: PathBuf) -> Result<Self, Error> {
        let unusable = |why| Error::NoRustCuda(Unusable::Library { library: library.clone(), why });
        let bytes = std::fs::read(&library).map_err(|error| unusable(WhyUnusable::Unreadable(error)))?;
        let driver = driver_of(&bytes).ok_or_else(|| unusable(WhyUnusable::NotOfRustc))?;
        let has_driver = |candidate: &Candidate| {
            let root = candidate.rustc.parent().and_then(Path::parent);
            root.is_some_and(|root| root.join("lib").join(driver).is_file())
        };
        let candidate = Candidate::all().into_iter().find(has_driver);
        let candidate = candidate.ok_or_else(|| unusable(WhyUnusable::NoCompiler { driver: driver.to_string() }))?;
        let compiler = DeviceCompiler::of_age(&candidate.rustc, OLDEST)
            .map_err(|rejected| unusable(WhyUnusable::Compiler(rejected)))?;
        Ok(Self { library, compiler })
    }

    /// The options of `rustc` for `core` and every other crate of the device build.
    pub(crate) fn flags(&self, shaders: &Shaders) -> Vec<String> {
        // The generator passes these to libNVVM. It accepts only options that differ from the default.
        let mut options = vec![format!("-arch={}", shaders.arch.replacen("sm_", "compute_", 1))];
        let switches =
            [("-ftz=1", shaders.ftz), ("-prec-sqrt=0", !shaders.prec_sqrt), ("-prec-div=0", !shaders.prec_div)];
        let switches = switches.into_iter().chain([("-fma=0", !shaders.fmad)]);
        let switches = switches.chain([("-generate-line-info", shaders.line_info)]);
        options.extend(switches.filter(|(_, on)| *on).map(|(option, _)| option.to_string()));
        vec![
            format!("-Zcodegen-backend={}", self.library.display()),
            "-Zsaturating_float_casts=false".into(),
            format!("-Cllvm-args={}", options.join(" ")),
        ]
    }
}

/// Attributes that crates are compiled with, so that entries may have [the attributes](prepare) by which the generator
/// recognises them.
pub(crate) const ENTRY_ATTRIBUTES: [&str; 2] = ["feature(register_tool)", "register_tool(nvvm_internal)"];

/// Prepares cargo for the generator.
pub(crate) fn prepare(cargo: &mut Command) {
    // It can't optimise across crates before it links, and can't link a static library.
    cargo.env(format!("CARGO_PROFILE_{}_LTO", PROFILE.to_uppercase()), "off").args(["--crate-type", "cdylib"]);
    // This variable makes the macros mark the entries.
    cargo.env("OPTIX_ENTRIES", "rustc_codegen_nvvm");
    // It is linked with libNVVM, which the user's library path finds.
    if let Some(path) = std::env::var_os(LIBRARY_PATH) {
        cargo.env(LIBRARY_PATH, path);
    }
}

/// The library, by name or by search.
fn library() -> Option<PathBuf> {
    if let Some(chosen) = std::env::var_os(CHOICE).filter(|chosen| !chosen.is_empty()) {
        return Some(chosen.into());
    }
    let name = format!("{}rustc_codegen_nvvm{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let path = std::env::var_os(LIBRARY_PATH).unwrap_or_default();
    std::env::split_paths(&path).map(|dir| dir.join(&name)).find(|file| file.is_file())
}

/// The file name of the compiler's own library that a generator is linked with: `librustc_driver-0123456789abcdef.so`.
fn driver_of(library: &[u8]) -> Option<&str> {
    let prefix = b"librustc_driver-";
    let at = library.windows(prefix.len()).position(|window| window == prefix)?;
    let name = library[at..].split(|byte| *byte == 0).next()?;
    std::str::from_utf8(name).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file with these bytes that stands for the generator.
    fn stub(name: &str, bytes: &[u8]) -> PathBuf {
        let dir = std::env::temp_dir().join(format!("optix-rust-cuda-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&dir).expect("writable");
        let file = dir.join("librustc_codegen_nvvm.so");
        std::fs::write(&file, bytes).expect("writable");
        file
    }

    #[test]
    fn what_is_wrong_with_a_library_is_said_with_what_to_install() {
        let cases: [(&str, &[u8], &str); 2] = [
            ("text", b"#!/bin/sh", "is no library for a rustc"),
            (
                "other",
                b"\x7fELF..librustc_driver-0123456789abcdef.so\0..",
                "is for a rustc with librustc_driver-0123456789abcdef.so, which no installed toolchain has",
            ),
        ];
        for (name, bytes, reason) in cases {
            let file = stub(name, bytes);
            let message = Backend::of(file.clone()).expect_err(name).to_string();
            for part in [&*file.to_string_lossy(), reason, "LLVM 7", "rust-src", CHOICE] {
                assert!(message.contains(part), "`{part}` is not in: {message}");
            }
            std::fs::remove_dir_all(file.parent().expect("its folder")).expect("removable");
        }
        let message = Backend::of("/nonexistent/librustc_codegen_nvvm.so".into()).expect_err("missing").to_string();
        assert!(message.contains("can't be read"), "{message}");
    }

    #[test]
    fn options_are_those_that_it_knows() {
        let rustc = PathBuf::from("rustc");
        let (version, llvm, library, archs) = (String::new(), String::new(), PathBuf::new(), Vec::new());
        let compiler = DeviceCompiler { rustc, version, release: crate::MINIMUM, llvm, library, archs };
        let backend = Backend { library: "x.so".into(), compiler };
        let flags = |shaders: &Shaders| backend.flags(shaders).pop().expect("there are some");
        let shaders = Shaders::new(".").arch("sm_86");
        assert_eq!(flags(&shaders), "-Cllvm-args=-arch=compute_86");
        let shaders = shaders.fmad(false).ftz(true).prec_div(false).prec_sqrt(false).line_info(true);
        let all = "-Cllvm-args=-arch=compute_86 -ftz=1 -prec-sqrt=0 -prec-div=0 -fma=0 -generate-line-info";
        assert_eq!(flags(&shaders), all);
    }
}
