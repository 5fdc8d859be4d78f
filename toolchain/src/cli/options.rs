//! How shader crates are compiled: the options that several commands have.

use std::path::{Path, PathBuf};

use clap::ArgAction::Set;
use optix_toolchain::{Codegen, Shaders};

/// Which crates, and how.
#[derive(clap::Args)]
pub(super) struct Options {
    /// The folder of one shader crate.
    #[arg(long = "crate", value_name = "PATH")]
    pub path: Option<PathBuf>,
    /// What makes the PTX.
    #[arg(long, value_enum, default_value_t = Generator::Rustc)]
    codegen: Generator,
    /// Whether `a * b + c` may become one `fma`.
    #[arg(long, value_name = "BOOL", default_value_t = true, action = Set)]
    fmad: bool,
    /// Whether `f32` instructions take and give zero for subnormal numbers.
    #[arg(long, value_name = "BOOL", default_value_t = false, action = Set, num_args = 0..=1, default_missing_value = "true")]
    ftz: bool,
    /// Whether `f32` division is correctly rounded.
    #[arg(long, value_name = "BOOL", default_value_t = true, action = Set)]
    prec_div: bool,
    /// Whether the `f32` square root is correctly rounded.
    #[arg(long, value_name = "BOOL", default_value_t = true, action = Set)]
    prec_sqrt: bool,
    /// Take functions such as `sin` and `pow` from NVIDIA's libdevice, with CUDA's results to the bit, instead of the
    /// project's own. With `--codegen nvvm`.
    #[arg(long)]
    libdevice: bool,
    /// Keep line information, which changes no instruction: nvcc's `-lineinfo`.
    #[arg(long)]
    debug: bool,
    /// Let arithmetic that overflows and a `debug_assert!` that fails end the program, as the profile `dev` does.
    #[arg(long)]
    checks: bool,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Generator {
    /// rustc's own back end.
    Rustc,
    /// NVIDIA's libNVVM: `cargo optix setup --nvvm` installs it.
    Nvvm,
    /// `rustc_codegen_nvvm` of the Rust-CUDA project, where you have it: `cargo optix doctor` says.
    #[value(name = "rustc_codegen_nvvm")]
    RustCuda,
}

impl Options {
    /// The crate in `path`, to be compiled so.
    pub fn shaders(&self, path: &Path, arch: &str) -> Shaders {
        let Self { path: _, codegen, fmad, ftz, prec_div, prec_sqrt, libdevice, debug, checks } = *self;
        let codegen = match codegen {
            Generator::Rustc => Codegen::Rustc,
            Generator::Nvvm => Codegen::Nvvm,
            Generator::RustCuda => Codegen::RustCuda,
        };
        let shaders = Shaders::new(path).arch(arch).codegen(codegen).line_info(debug);
        let shaders = if checks { shaders.checks(true) } else { shaders };
        shaders.fmad(fmad).ftz(ftz).prec_div(prec_div).prec_sqrt(prec_sqrt).libdevice(libdevice)
    }
}
