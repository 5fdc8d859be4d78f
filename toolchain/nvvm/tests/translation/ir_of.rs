//! The LLVM IR of whole crates: functions that are inlined where they are used included.

use std::fs;
use std::path::Path;
use std::process::Command;

use optix_toolchain::DeviceCompiler;

const TARGET: &str = "nvptx64-nvidia-cuda";

/// Functions of `core::arch::nvptx` that rustc itself refuses to compile.
const REFUSED_BY_RUSTC: [&str; 2] = ["llvm_f16x2_minimum(a, b)", "llvm_f16x2_maximum(a, b)"];

const GLAM: &str = "[package]\nname = \"whole\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[dependencies]\n\
    glam = { version = \"0.34\", default-features = false, features = [\"bytemuck\", \"cuda\", \"nostd-libm\", \"f64\", \"i16\", \
    \"i32\", \"u16\", \"u32\"] }\n\n[profile.release]\npanic = \"abort\"\ncodegen-units = 1\n\n[workspace]\n";

/// `core` and glam by name. None: there is no device compiler, which is said.
pub(super) fn core_and_glam(test: &str) -> Option<Vec<(&'static str, String)>> {
    let compiler = match DeviceCompiler::find() {
        Ok(compiler) => compiler,
        Err(error) => {
            eprintln!("{test}: not run, {error}");
            return None;
        }
    };
    let dir = std::env::temp_dir().join(format!("optix-whole-{}", std::process::id()));
    let texts = vec![("core", core(&compiler, &dir)), ("glam", glam(&compiler, &dir))];
    fs::remove_dir_all(&dir).expect("removable");
    Some(texts)
}

/// The IR of `core`, and a sysroot with it in `dir`.
fn core(compiler: &DeviceCompiler, dir: &Path) -> String {
    fs::create_dir_all(dir.join("library")).expect("writable");
    for part in ["core", "portable-simd", "stdarch"] {
        let mut copy = Command::new("cp");
        copy.arg("-r").arg(compiler.library.join(part)).arg(dir.join("library"));
        assert!(copy.status().expect("cp runs").success(), "{part} is copied");
    }
    let packed = dir.join("library/stdarch/crates/core_arch/src/nvptx/packed.rs");
    if let Ok(mut text) = fs::read_to_string(&packed) {
        REFUSED_BY_RUSTC.iter().for_each(|call| text = text.replace(call, "a"));
        fs::write(&packed, text).expect("writable");
    }
    let builtins = dir.join("compiler_builtins.rs");
    let text = "#![no_std]\n#![feature(compiler_builtins)]\n#![compiler_builtins]\n";
    fs::write(&builtins, text).expect("writable");
    let edition = compiler.core_edition().expect("it has one");
    let ir = dir.join("core.ll");
    for (name, source) in [("core", &dir.join("library/core/src/lib.rs")), ("compiler_builtins", &builtins)] {
        let mut rustc = Command::new(&compiler.rustc);
        rustc
            .args(["--crate-name", name, "--crate-type", "rlib", "--edition", &edition, "--target", TARGET])
            .args(["--cap-lints", "allow", "-Cpanic=abort", "-Copt-level=3", "-Ccodegen-units=1", "-Ctarget-cpu=sm_75"])
            .args(["-Zforce-unstable-if-unmarked", "-Clink-dead-code", "--sysroot"])
            .arg(dir)
            .arg("--out-dir")
            .arg(dir.join("lib/rustlib").join(TARGET).join("lib"))
            .arg(if name == "core" { format!("--emit=link,llvm-ir={}", ir.display()) } else { "--emit=link".into() })
            .arg(source)
            .env("RUSTC_BOOTSTRAP", "1")
            .env_remove("LD_LIBRARY_PATH");
        assert!(rustc.status().expect("rustc runs").success(), "{name} compiles");
    }
    fs::read_to_string(&ir).expect("there it is")
}

/// The IR of glam, with the features that device code has, on the sysroot in `dir`.
fn glam(compiler: &DeviceCompiler, dir: &Path) -> String {
    let package = dir.join("glam");
    fs::create_dir_all(package.join("src")).expect("writable");
    fs::write(package.join("Cargo.toml"), GLAM).expect("writable");
    fs::write(package.join("src/lib.rs"), "#![no_std]\n").expect("writable");
    let ir = dir.join("glam.ll");
    let mut command = Command::new(env!("CARGO"));
    command
        .current_dir(&package)
        .args(["rustc", "--quiet", "--release", "--package", "glam", "--target", TARGET, "--target-dir"])
        .arg(dir.join("target"))
        .args(["--", "-Clink-dead-code", &format!("--emit=llvm-ir={}", ir.display())])
        .env("RUSTC", &compiler.rustc)
        .env("RUSTC_BOOTSTRAP", "1")
        // The wrappers, flags and libraries of the cargo that runs this test are for another compiler.
        .env("RUSTC_WRAPPER", "")
        .env("RUSTC_WORKSPACE_WRAPPER", "")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .env_remove("LD_LIBRARY_PATH")
        .env("RUSTFLAGS", format!("--sysroot {} -Ctarget-cpu=sm_75", dir.display()));
    assert!(command.status().expect("cargo runs").success(), "glam compiles");
    fs::read_to_string(&ir).expect("there it is")
}
