//! What a `build.rs` tells cargo, and what cargo tells it.

use std::path::{Path, PathBuf};

use crate::compiler;
use crate::device_build::Built;
use crate::error::{Doing, Error};
use crate::options::Shaders;
use crate::original::Original;
use crate::outer::Outer;
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
    shaders.outer = Outer::of_build_script();
    println!("cargo::rerun-if-env-changed=OPTIX_RUSTC");

    let area = util::target_dir(&out_dir).join("optix");
    let (name, text) = match shaders.compile_in(area) {
        Ok(built) => {
            built.inputs.iter().for_each(|input| rerun_if_changed(input));
            // No file holds the options of the next build, so the script has to run each time. It does where it names a
            // file that does not exist: cargo counts that as changed.
            if shaders.outer.as_ref().is_some_and(Outer::has_configuration) {
                rerun_if_changed(&out_dir.join("none"));
            }
            let Built { name, text, .. } = built;
            for (function, bytes) in ptx::local_memory(&text) {
                println!("cargo::warning={function} keeps {bytes} bytes in local memory: {LOCAL_MEMORY}");
            }
            for one in ptx::suspicious(&text) {
                println!("cargo::warning=in {}, {one}", one.function);
            }
            (name, text)
        }
        Err(error @ (Error::NoDeviceCompiler { .. } | Error::SwitchedOff)) => {
            println!("cargo::warning=shaders run on the CPU only: {error}");
            compiler::installation_records().iter().for_each(|record| rerun_if_changed(record));
            let package = Original::find(&shaders)?.shaders;
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
