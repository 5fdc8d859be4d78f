//! Compiles the tests' shaders and kernels to PTX, for those that run on a GPU as well.

use std::path::{Path, PathBuf};
use std::process::Command;

use optix_toolchain::{Codegen, Error, Shaders};

fn main() {
    optix_toolchain::shaders("shaders");
    optix_toolchain::shaders("round-trip");
    let differential = Shaders::new("differential").fmad(false);
    kernels("differential.rustc.ptx", differential.clone());
    kernels("differential.nvvm.ptx", differential.codegen(Codegen::Nvvm));
    let maths = Shaders::new("maths");
    kernels("maths.rustc.ptx", maths.clone());
    kernels("maths.nvvm.ptx", maths.codegen(Codegen::Nvvm).default_features(false).features(["libdevice"]));
    cuda("maths.nvcc.ptx", Path::new("maths/cuda/functions.cu"));
    println!("cargo::rerun-if-env-changed=OPTIX_NVVM");
}

fn out(file: &str) -> PathBuf {
    PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets it")).join(file)
}

fn fail(message: &str) -> ! {
    println!("cargo::error={}", message.replace('\n', " "));
    std::process::exit(1);
}

/// Compiles kernels that OptiX has no part in; to an empty file where the generator is not there.
fn kernels(file: &str, kernels: Shaders) {
    let out = out(file);
    // The target directory's own folder for this, where `core` is compiled already: OUT_DIR is four levels below it.
    let area = out.ancestors().nth(5).unwrap_or(&out).join("optix");
    let text = match kernels.compile_in(area) {
        Ok(built) => {
            built.inputs.iter().for_each(|input| println!("cargo::rerun-if-changed={}", input.display()));
            built.text
        }
        Err(Error::NoNvvm(_) | Error::NoDeviceCompiler { .. } | Error::SwitchedOff) => String::new(),
        Err(error) => fail(&error.to_string()),
    };
    std::fs::write(out, text).expect("writable");
}

/// Compiles CUDA C++ with the nvcc that the environment variable `NVCC` names; to an empty file without one.
fn cuda(file: &str, source: &Path) {
    println!("cargo::rerun-if-env-changed=NVCC");
    println!("cargo::rerun-if-changed={}", source.display());
    let out = out(file);
    let Some(nvcc) = std::env::var_os("NVCC") else {
        return std::fs::write(out, "").expect("writable");
    };
    match Command::new(&nvcc).args(["-ptx", "-arch=compute_75", "-o"]).arg(out).arg(source).output() {
        Ok(done) if done.status.success() => {}
        Ok(done) => fail(&format!("{}: {}", nvcc.display(), String::from_utf8_lossy(&done.stderr))),
        Err(error) => fail(&format!("NVCC={}: {error}", nvcc.display())),
    }
}
