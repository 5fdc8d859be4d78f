//! `cargo optix doctor`

use std::path::PathBuf;
use std::process::{Command, ExitCode};

use optix_toolchain::inspect::ptxas::Ptxas;
use optix_toolchain::nvvm::{self, Library, PtxVersion};
use optix_toolchain::rust_cuda::{self, Backend};
use optix_toolchain::{Candidate, DEFAULT_ARCH, DeviceCompiler, Error, MINIMUM, Rejected, Why};

use super::libraries::{self, Driver};
use super::{Outcome, cargo, setup};

/// The oldest driver branch with OptiX 9.0.
const DRIVER: &str = "driver 570 or newer: https://www.nvidia.com/drivers";

pub(super) fn run() -> Outcome {
    let can_compile = device_compilers();
    report("cargo", program_version(cargo()), "install it from https://rustup.rs");
    driver();
    optix();
    say!("");
    say!("code generators besides rustc's own (optional):");
    nvvm();
    let backend = Backend::find()
        .map(|Backend { library, compiler }| format!("{} for {}", library.display(), setup::describe(&compiler)));
    report("rustc_codegen_nvvm", backend.map_err(|error| missing(&error)), rust_cuda::INSTALL);
    let ptxas = Ptxas::find().map(|ptxas| format!("{}, {}", ptxas.program.display(), ptxas.version));
    report("ptxas", ptxas.ok_or_else(String::new), Ptxas::MISSING);
    say!("");
    say!(
        "{}",
        if can_compile {
            "This machine can compile shaders."
        } else {
            "This machine can't compile shaders: `cargo optix setup`."
        }
    );
    Ok(if can_compile { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Prints one line: the thing and what was found, or what is missing and what installs it.
fn report(what: &str, found: Result<String, String>, fix: &str) {
    match found {
        Ok(found) => say!("  ok      {what}: {found}"),
        Err(reason) if reason.is_empty() => say!("  missing {what}; {fix}"),
        Err(reason) => say!("  missing {what}: {reason}; {fix}"),
    }
}

/// Prints every candidate, and returns whether one of them can compile shaders.
fn device_compilers() -> bool {
    let mut chosen = false;
    for Candidate { rustc, origin } in Candidate::all() {
        match DeviceCompiler::check(&rustc) {
            Ok(compiler) => {
                let note = if chosen { "also possible" } else { "used" };
                chosen = true;
                let archs = (compiler.archs.first(), compiler.archs.last());
                let archs =
                    if let (Some(first), Some(last)) = archs { format!("{first} to {last}") } else { String::new() };
                report(
                    "device compiler",
                    Ok(format!(
                        "{} ({origin}, {note}), for {archs}, default {DEFAULT_ARCH}",
                        setup::describe(&compiler)
                    )),
                    "",
                );
            }
            Err(rejected) => say!("  -       {origin} is no device compiler: {rejected}; {}", fix(&rejected)),
        }
    }
    if !chosen {
        report("device compiler", Err(String::new()), "`cargo optix setup`");
    }
    chosen
}

/// The command that installs what a `rustc` lacks as a device compiler.
fn fix(rejected: &Rejected) -> String {
    match &rejected.why {
        Why::NoSources(path) if path.starts_with("/usr") => "install its distribution's package of sources".into(),
        Why::NoSources(path) => {
            // <rustup>/toolchains/<name>/lib/rustlib/src/rust/library
            let toolchain = path.ancestors().nth(5).and_then(|root| root.file_name()).unwrap_or_default();
            format!("`rustup component add rust-src --toolchain {}`", toolchain.to_string_lossy())
        }
        Why::TooOld(_) => format!("{MINIMUM} is needed: `rustup update`"),
        _ => "it is passed over".into(),
    }
}

fn driver() {
    let kernel = std::fs::read_to_string("/proc/driver/nvidia/version").unwrap_or_default();
    // NVRM version: NVIDIA UNIX x86_64 Kernel Module  580.159.04  ..
    let is_version = |word: &&str| word.contains('.') && word.bytes().all(|b| b.is_ascii_digit() || b == b'.');
    let kernel = kernel.split_whitespace().find(is_version);
    let driver = Driver::query();
    let text = driver.as_ref().map(|driver| {
        let (major, minor) = driver.cuda;
        format!("{}, CUDA {major}.{minor}", kernel.unwrap_or("version unknown"))
    });
    report("NVIDIA driver", text.map_err(|_| String::new()), DRIVER);
    let Ok(driver) = driver else { return };
    for gpu in &driver.gpus {
        let (major, minor) = gpu.compute_capability;
        report("GPU", Ok(format!("{}, sm_{major}{minor}", gpu.name)), "");
    }
    if driver.gpus.is_empty() {
        report("GPU", Err(String::new()), "the driver sees none: `nvidia-smi` says why");
    }
}

fn optix() {
    let abi = libraries::OPTIX_ABI;
    let found = match libraries::optix_accepts_abi() {
        Ok(true) => Ok(format!("{}, function table {abi} (OptiX 9.0)", libraries::OPTIX)),
        Ok(false) => Err(format!("{} is older than OptiX 9.0 and refuses function table {abi}", libraries::OPTIX)),
        Err(_) => Err(format!("no {}", libraries::OPTIX)),
    };
    report("OptiX", found, &format!("it comes with {DRIVER}; without it programs run on the CPU"));
}

fn nvvm() {
    let driver = PtxVersion::of_driver();
    let used = nvvm::choose().map(|library| library.path);
    let found = nvvm::libraries();
    for path in &found {
        let read = || -> Result<String, nvvm::Failure> {
            let library = Library::open(path)?;
            let ((major, minor), ptx) = (library.ir_version()?, library.ptx_version()?);
            let fits = match driver {
                Some(driver) if ptx > driver => format!("newer than the driver's {driver}, so it is passed over"),
                Some(driver) => format!("the driver takes up to {driver}"),
                None => "no driver to ask".into(),
            };
            let used = if used.as_ref() == Ok(path) { ", used" } else { "" };
            Ok(format!("{}, NVVM IR {major}.{minor}, writes PTX {ptx}: {fits}{used}", path.display()))
        };
        match read() {
            Ok(text) => report("libNVVM", Ok(text), ""),
            Err(failure) => {
                report("libNVVM", Err(format!("{}: {failure}", path.display())), "`cargo optix setup --nvvm`")
            }
        }
    }
    if found.is_empty() {
        report("libNVVM", Err(String::new()), "`cargo optix setup --nvvm`");
    }
}

/// What is missing of `rustc_codegen_nvvm`, without the advice on what to install.
fn missing(error: &Error) -> String {
    if let Error::NoRustCuda(reason) = error { reason.to_string() } else { error.to_string() }
}

/// The last line of what a program says to `--version`.
fn program_version(program: impl Into<PathBuf>) -> Result<String, String> {
    let output = Command::new(program.into()).arg("--version").output().map_err(|_| String::new())?;
    let text = String::from_utf8_lossy(&output.stdout);
    text.lines().last().map(|line| line.trim().to_string()).ok_or_else(String::new)
}
