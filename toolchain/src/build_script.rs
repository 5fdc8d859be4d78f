//! The conversation with cargo in a `build.rs`.

use std::path::{Path, PathBuf};

use crate::compiler;
use crate::device_build::{self, Built};
use crate::error::{Doing, Error};
use crate::options::Shaders;
use crate::{ptx, util};

/// What to do about it.
const LOCAL_MEMORY: &str = "index arrays by constants, and pass by value what does not fit registers";

/// Compiles, tells cargo the outcome, and ends the process where there is none.
pub(crate) fn compile(shaders: &Shaders) {
    if let Err(error) = try_compile(shaders) {
        println!("cargo::error={error}");
        eprintln!("error: {error}");
        std::process::exit(1);
    }
}

fn try_compile(shaders: &Shaders) -> Result<(), Error> {
    let out_dir = variable("OUT_DIR")?;
    let mut shaders = shaders.clone();
    shaders.path = variable("CARGO_MANIFEST_DIR")?.join(&shaders.path);
    // `debug` is the profile `dev` and those that inherit it.
    shaders.checks.get_or_insert(std::env::var_os("PROFILE").is_some_and(|profile| profile == "debug"));
    println!("cargo::rerun-if-env-changed=OPTIX_RUSTC");

    let area = util::target_dir(&out_dir).join("optix");
    let (name, text) = match shaders.compile_in(area) {
        Ok(built) => {
            built.inputs.iter().for_each(|input| rerun_if_changed(input));
            let Built { name, text, .. } = built;
            for (function, bytes) in ptx::local_memory(&text) {
                println!("cargo::warning={function} keeps {bytes} bytes in local memory: {LOCAL_MEMORY}");
            }
            (name, text)
        }
        Err(error @ (Error::NoDeviceCompiler { .. } | Error::SwitchedOff)) => {
            println!("cargo::warning=shaders run on the CPU only: {error}");
            compiler::installation_records().iter().for_each(|record| rerun_if_changed(record));
            let (package, _) = device_build::shader_crate(&shaders.path)?;
            (package.library.unwrap_or(package.name), String::new())
        }
        Err(error) => return Err(error),
    };
    let ptx = out_dir.join(format!("{name}.ptx"));
    std::fs::write(&ptx, text).doing(|| format!("cannot write {}", ptx.display()))?;
    println!("cargo::rustc-env=OPTIX_PTX_{}={}", name, ptx.display());
    Ok(())
}

fn rerun_if_changed(file: &Path) {
    println!("cargo::rerun-if-changed={}", file.display());
}

fn variable(name: &str) -> Result<PathBuf, Error> {
    std::env::var_os(name).map(PathBuf::from).ok_or_else(|| Error::Output {
        of: "cargo".into(),
        reason: format!("{name} is not set; `compile` is for build scripts, other programs use `compile_in`"),
    })
}
