//! Compiles the tests' shaders to PTX, for those that run on a GPU as well.

use std::path::PathBuf;

use optix_toolchain::{Codegen, Error, Shaders};

fn main() {
    optix_toolchain::shaders("shaders");
    optix_toolchain::shaders("maths");
    optix_toolchain::shaders("round-trip");
    differential("rustc", Codegen::Rustc);
    differential("nvvm", Codegen::Nvvm);
    println!("cargo::rerun-if-env-changed=OPTIX_NVVM");
}

/// Compiles the functions of the differential test; an empty file where the generator is not there.
fn differential(name: &str, codegen: Codegen) {
    let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets it"));
    // The target directory's own folder for this, where `core` is compiled already: OUT_DIR is four levels below it.
    let area = out.ancestors().nth(4).unwrap_or(&out).join("optix");
    let text = match Shaders::new("differential").fmad(false).codegen(codegen).compile_in(area) {
        Ok(built) => {
            built.inputs.iter().for_each(|input| println!("cargo::rerun-if-changed={}", input.display()));
            built.text
        }
        Err(Error::NoNvvm(_) | Error::NoDeviceCompiler { .. } | Error::SwitchedOff) => String::new(),
        Err(error) => {
            println!("cargo::error={error}");
            std::process::exit(1);
        }
    };
    std::fs::write(out.join(format!("differential.{name}.ptx")), text).expect("writable");
}
