//! The options of a device build.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use crate::device_build::{self, Built};
use crate::error::Error;
use crate::outer::{self, Outer};
use crate::sysroot::PANIC;
use crate::util;

/// The architecture that PTX is written for unless [`Shaders::arch`] says otherwise.
///
/// Turing is the first generation with ray-tracing cores, and the oldest that drivers newer than the 580 branch run.
/// PTX is compiled again by the driver for the GPU that is there, and may be older than it but not newer: a GPU before
/// Turing needs an older architecture here (OptiX 9 on driver 580 takes them from Maxwell, `sm_50`, on).
pub const DEFAULT_ARCH: &str = "sm_75";

/// Which code generator writes the PTX.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Codegen {
    /// `rustc`'s own NVPTX back end.
    #[default]
    Rustc,
    /// NVIDIA's libNVVM, which nvcc uses as well, [loaded](crate::nvvm) at run time.
    #[cfg(feature = "nvvm")]
    Nvvm,
    /// `rustc_codegen_nvvm` of the Rust-CUDA project, with the nightly that it is built for:
    /// [`rust_cuda`](crate::rust_cuda).
    RustCuda,
}

impl Codegen {
    pub(crate) fn links_libdevice(self) -> bool {
        match self {
            #[cfg(feature = "nvvm")]
            Self::Nvvm => true,
            Self::Rustc | Self::RustCuda => false,
        }
    }
}

/// A shader crate and how to compile it; [`shaders`](crate::shaders) with options.
///
/// The defaults are nvcc's: multiplications and additions contract to `fma`, division and square root are correctly
/// rounded, subnormal numbers are kept, and there is no line information.
///
/// ```no_run
/// // build.rs
/// optix_toolchain::Shaders::new("shaders").arch("sm_86").line_info(true).compile();
/// ```
#[derive(Clone, Debug)]
pub struct Shaders {
    pub(crate) path: PathBuf,
    pub(crate) arch: String,
    pub(crate) codegen: Codegen,
    pub(crate) fmad: bool,
    pub(crate) ftz: bool,
    pub(crate) prec_div: bool,
    pub(crate) prec_sqrt: bool,
    pub(crate) libdevice: bool,
    pub(crate) line_info: bool,
    /// `None` for the checks of the profile that the program is built with.
    pub(crate) checks: Option<bool>,
    /// `None` for the features with which the program uses the crate.
    pub(crate) features: Option<Vec<String>>,
    pub(crate) default_features: Option<bool>,
    pub(crate) profile: Option<String>,
    pub(crate) locked: bool,
    pub(crate) cargo_options: Vec<OsString>,
    pub(crate) quiet: bool,
    /// The build of the program, if a build script asks for the shaders.
    pub(crate) outer: Option<Outer>,
}

impl Shaders {
    /// The shader crate in the folder `path`, which is relative to the package being built, or outside of a build
    /// script to the current folder.
    pub fn new(path: impl AsRef<Path>) -> Self {
        Self {
            path: path.as_ref().to_path_buf(),
            arch: DEFAULT_ARCH.to_string(),
            codegen: Codegen::default(),
            fmad: true,
            ftz: false,
            prec_div: true,
            prec_sqrt: true,
            libdevice: false,
            line_info: false,
            checks: None,
            features: None,
            default_features: None,
            profile: None,
            locked: false,
            cargo_options: Vec::new(),
            quiet: true,
            outer: None,
        }
    }

    /// The oldest architecture that the PTX has to run on, such as `sm_86`. Default: [`DEFAULT_ARCH`].
    pub fn arch(mut self, arch: impl Into<String>) -> Self {
        self.arch = arch.into();
        self
    }

    /// The code generator that writes the PTX. Default: [`Codegen::Rustc`].
    pub fn codegen(mut self, codegen: Codegen) -> Self {
        self.codegen = codegen;
        self
    }

    /// Whether `a * b + c` may become one `fma`, which rounds once instead of twice: nvcc's `-fmad`. Default: true.
    pub fn fmad(mut self, on: bool) -> Self {
        self.fmad = on;
        self
    }

    /// Whether `f32` instructions take and give zero for subnormal numbers: nvcc's `-ftz`. Default: false.
    pub fn ftz(mut self, on: bool) -> Self {
        self.ftz = on;
        self
    }

    /// Whether `f32` division is correctly rounded, instead of within 2 ulp: nvcc's `-prec-div`. Default: true.
    pub fn prec_div(mut self, on: bool) -> Self {
        self.prec_div = on;
        self
    }

    /// Whether the `f32` square root is correctly rounded, instead of within 1 ulp: nvcc's `-prec-sqrt`. Default: true.
    pub fn prec_sqrt(mut self, on: bool) -> Self {
        self.prec_sqrt = on;
        self
    }

    /// Whether functions such as `sin` and `pow` are NVIDIA's, from the libdevice that comes with libNVVM, with CUDA's
    /// results to the bit; [`Codegen::Nvvm`] alone links it. Default: false, the project's own, which are more exact and
    /// the same with every code generator (docs/maths.md).
    pub fn libdevice(mut self, on: bool) -> Self {
        self.libdevice = on;
        self
    }

    /// Whether the PTX says which source line an instruction comes from, for profilers: nvcc's `-lineinfo`. It
    /// changes no instruction. Default: false.
    pub fn line_info(mut self, line_info: bool) -> Self {
        self.line_info = line_info;
        self
    }

    /// Whether arithmetic that overflows, and a `debug_assert!` that fails, ends the program, as `overflow-checks` and
    /// `debug-assertions` do in a profile. Default: what the [profile](Self::profile) says for each crate. Indices are
    /// always checked.
    pub fn checks(mut self, on: bool) -> Self {
        self.checks = Some(on);
        self
    }

    /// Features of the shader crate to switch on. Default: in a build script those with which the program uses the crate,
    /// so that this is needed only where it does not use it; otherwise none but the default features. Other features
    /// than the program's are an error.
    pub fn features<S: Into<String>>(mut self, features: impl IntoIterator<Item = S>) -> Self {
        self.features = Some(features.into_iter().map(Into::into).collect());
        self
    }

    /// Whether the shader crate's default features are on. Default: as for [`features`](Self::features).
    pub fn default_features(mut self, on: bool) -> Self {
        self.default_features = Some(on);
        self
    }

    /// The profile of the user's workspace that says which [checks](Self::checks) there are; PTX is optimised in any
    /// case. Default: `release`. In a build script this has no effect: the program's own profile counts.
    pub fn profile(mut self, name: impl Into<String>) -> Self {
        self.profile = Some(name.into());
        self
    }

    /// Whether it is an error if the lock file of the user's workspace is missing or out of date: cargo's `--locked`.
    /// Default: false. In a build script it is always an error.
    pub fn locked(mut self, on: bool) -> Self {
        self.locked = on;
        self
    }

    /// Options for every cargo that takes part in the build, such as `--offline` and `--config=KEY=VALUE`. In a build
    /// script this has no effect: the options of the cargo that runs it count.
    pub fn cargo_options<S: Into<OsString>>(mut self, options: impl IntoIterator<Item = S>) -> Self {
        self.cargo_options = options.into_iter().map(Into::into).collect();
        self
    }

    /// The chosen features as command-line options of cargo.
    pub(crate) fn feature_options(&self) -> Vec<String> {
        let without_default = self.default_features == Some(false);
        let features = self.features.as_ref().map(|features| format!("--features={}", features.join(",")));
        without_default.then(|| "--no-default-features".to_string()).into_iter().chain(features).collect()
    }

    /// The profile that says which run-time checks there are.
    pub(crate) fn profile_name(&self) -> &str {
        let chosen = || self.profile.as_deref().unwrap_or("release");
        self.outer.as_ref().map_or_else(chosen, |outer| &outer.profile)
    }

    /// Whether to keep silent about progress, as a build script should. Diagnostics are shown always. Default: true.
    pub fn quiet(mut self, quiet: bool) -> Self {
        self.quiet = quiet;
        self
    }

    /// Compiles it from a `build.rs`: see [`shaders`](crate::shaders).
    pub fn compile(self) {
        crate::build_script::compile(&self);
    }

    /// Compiles it from any other program. `area` is a folder for intermediate files: calls with the same one share the
    /// work that is common to them. Cargo decides what has to be done; a call when nothing has changed takes about 0.6
    /// s.
    ///
    /// ```no_run
    /// let built = optix_toolchain::Shaders::new("shaders").compile_in("target/optix")?;
    /// println!("{}: {}", built.ptx.display(), built.entries.join(", "));
    /// # Ok::<(), optix_toolchain::Error>(())
    /// ```
    pub fn compile_in(&self, area: impl AsRef<Path>) -> Result<Built, Error> {
        device_build::build(self, area.as_ref())
    }

    /// Options of LLVM for what is different about OptiX.
    const LLVM: [&str; 5] = [
        // OptiX inlines every function anyway. Until it does, a function that is called would only pass its values
        // through memory.
        "-inline-threshold=100000",
        // Threads diverge at a branch, so conditions are joined where that costs a few instructions.
        "-bonus-inst-threshold=10",
        // If a loop is peeled, its trace calls are there twice, and OptiX cuts a program in two at each of them.
        "-unroll-peel-max-count=0",
        // What is computed before a trace call stays there. If it moved behind the call, all the values that it is made
        // of would have to be kept in memory across the call.
        "-instcombine-code-sinking=false",
        "-disable-machine-sink",
    ];

    /// The options of `rustc` for each crate of the device build, for its own code generator.
    pub(crate) fn rustflags(&self) -> Vec<String> {
        let mut llvm = Self::LLVM.join(" ");
        llvm.push_str(&format!(" -nvptx-fma-level={}", if self.fmad { 2 } else { 0 }));
        // `div.full`, `sqrt.approx`. LLVM has no switch for `ftz`: see `ptx::ftz`.
        if !self.prec_div {
            llvm.push_str(" -nvptx-prec-divf32=1");
        }
        if !self.prec_sqrt {
            llvm.push_str(" -nvptx-prec-sqrtf32=0");
        }
        // Our `libm` asks for this.
        let libm = [(!self.prec_sqrt, "--cfg=optix_approximate_sqrt"), (self.libdevice, "--cfg=optix_libdevice")];
        let libm = libm.into_iter().filter(|(is_set, _)| *is_set).map(|(_, flag)| flag.to_string());
        let flags = [
            format!("-Ctarget-cpu={}", self.arch),
            // An indirect branch costs a GPU more than a few comparisons.
            "-Cjump-tables=no".into(),
            // `debug-assertions` would also switch on `core`'s checks of preconditions of `unsafe` functions. They keep
            // payloads in memory.
            "-Zub-checks=no".into(),
            format!("-Cllvm-args={llvm}"),
        ];
        flags.into_iter().chain(libm).chain(PANIC.map(String::from)).collect()
    }

    /// A key that differs between builds whose intermediate files must not be mixed: for the crate, its workspace and
    /// its features.
    pub(crate) fn key(&self, dir: &Path, root: &Path, features: &[String]) -> String {
        let maths = [self.fmad, self.ftz, self.prec_div, self.prec_sqrt, self.libdevice, self.line_info];
        let switches = format!("{maths:?}{:?}{:?}{}", self.checks, self.codegen, self.profile_name());
        let (dir, root, flags) = (dir.to_string_lossy(), root.to_string_lossy(), outer::flags());
        let parts = [dir.as_ref(), root.as_ref(), self.arch.as_str(), switches.as_str()];
        util::hash(parts.into_iter().chain(flags.iter().chain(features).map(String::as_str)))
    }
}
