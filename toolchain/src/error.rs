//! What can go wrong, each with what to do about it.

use std::borrow::Cow;
use std::fmt;
use std::path::PathBuf;
use std::process::ExitStatus;

use crate::compiler::{MINIMUM, Rejected};
use crate::messages::{NeedsStd, OfStd};
use crate::missing::Culprit;
use crate::ptx;

/// Why a shader crate was not compiled. `Display` is one line: what is wrong, and after a semicolon [what to do](Self::remedy).
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    /// No `rustc` on this machine can compile for the device. Not fatal to a build: the program can run on the CPU.
    NoDeviceCompiler {
        /// The compilers that were looked at, in order, and what each lacks.
        rejected: Vec<Rejected>,
    },
    /// `OPTIX_RUSTC=none` was set. Not fatal to a build either: the program can run on the CPU.
    SwitchedOff,
    /// `OPTIX_RUSTC` names a compiler which can't be used.
    ChosenCompiler(Rejected),
    /// The compiler can't generate code for this architecture.
    UnknownArch {
        /// The name that was asked for, such as `sm_75`.
        arch: String,
        /// The names that the compiler knows.
        known: Vec<String>,
    },
    /// The folder is no shader crate.
    NotAShaderCrate {
        /// The folder.
        path: PathBuf,
        /// What it lacks.
        lacks: Lacking,
    },
    /// Host and device would be made from different packages or features.
    Differs {
        /// The shader crate.
        package: String,
        /// What differs.
        differences: Vec<Difference>,
    },
    /// A crate that the shader crate uses needs the standard library.
    NeedsStd(NeedsStd),
    /// The shader crate uses a name of the standard library. The compiler's diagnostics went to standard error.
    OfStd {
        /// Its name.
        package: String,
        /// What it uses.
        of_std: OfStd,
    },
    /// A `cargo` or `rustc` that this crate ran has failed; its own diagnostics went to standard error.
    Step {
        /// What it was doing.
        doing: String,
        /// How it ended.
        status: ExitStatus,
    },
    /// Cargo has failed, but no Rust code had an error: it was in a build script, or LLVM failed while it generated
    /// code. The messages went to standard error.
    Aborted {
        /// What it was doing.
        doing: String,
        /// How it ended.
        status: ExitStatus,
    },
    /// The shader crate uses something that the device does not have, such as a heap.
    Missing(Box<Culprit>),
    /// The PTX can't be loaded by OptiX.
    Ptx {
        /// Where it is.
        path: PathBuf,
        /// What is wrong with it.
        problem: ptx::Problem,
    },
    /// libNVVM was asked for, and no library on this machine can be used.
    #[cfg(feature = "nvvm")]
    NoNvvm(crate::nvvm::NoLibrary),
    /// The shader crate needs libdevice, and the libNVVM that is used comes without it.
    #[cfg(feature = "nvvm")]
    NoLibdevice {
        /// The libNVVM.
        library: PathBuf,
    },
    /// libdevice was asked for, but only libNVVM can link it, and another code generator was chosen.
    Libdevice,
    /// `rustc_codegen_nvvm` was asked for, and none on this machine can be used.
    NoRustCuda(crate::rust_cuda::Unusable),
    /// libNVVM reported an error.
    #[cfg(feature = "nvvm")]
    Nvvm(crate::nvvm::Failure),
    /// The shader crate has something that can't be translated for libNVVM.
    #[cfg(feature = "nvvm")]
    Refused(crate::nvvm::Refusal),
    /// A program's output was not what it should be.
    Output {
        /// What was being read.
        of: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A file or a program could not be used.
    Io {
        /// What was being done, with the path.
        doing: String,
        /// The reason.
        source: std::io::Error,
    },
}

/// What a folder lacks that is to be a shader crate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Lacking {
    /// The folder itself is not there.
    Folder,
    /// It has no `Cargo.toml`.
    Manifest,
    /// Its `Cargo.toml` is of a workspace alone.
    Package,
    /// The package has no library.
    Library,
}

impl Lacking {
    fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Folder => ("there is no such folder", "name the folder of the shader crate's Cargo.toml"),
            Self::Manifest => ("it has no Cargo.toml", "name the folder of the shader crate's Cargo.toml"),
            Self::Package => ("its Cargo.toml is no package", "name the folder of a package, not of its workspace"),
            Self::Library => ("it has no library", "its code belongs into src/lib.rs"),
        }
    }
}

/// What differs between the host's build of a shader crate and the device build.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Difference {
    /// A feature of the shader crate that only one of the two has.
    Feature {
        /// The feature.
        feature: String,
        /// Whether it is the device build.
        on_device: bool,
    },
    /// The device build does not have the shader crate.
    NotOnDevice {
        /// The shader crate.
        package: String,
    },
    /// A dependency of another version or source.
    Package {
        /// Its name.
        package: String,
        /// Version and source for the host; none if it is not used there.
        host: Option<String>,
        /// Version and source for the device.
        device: String,
    },
    /// A dependency with other features.
    Features {
        /// Its name.
        package: String,
        /// Those for the host; none if it is not compiled there.
        host: Option<Vec<String>>,
        /// Those for the device.
        device: Vec<String>,
    },
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |features: &[String]| format!("[{}]", features.join(", "));
        match self {
            Self::Feature { feature, on_device: true } => {
                write!(f, "its feature `{feature}` is on on the device, by the build script, only")
            }
            Self::Feature { feature, on_device: false } => {
                write!(f, "its feature `{feature}` is on in the program that is built only")
            }
            Self::NotOnDevice { package } => write!(f, "`{package}` is not in the device build"),
            Self::Package { package, host, device } => {
                let host = host.as_deref().unwrap_or("not used");
                write!(f, "`{package}` is {host} there and {device} on the device")
            }
            Self::Features { package, host, device } => {
                let host = host.as_deref().map_or("not compiled".into(), list);
                write!(f, "the features of `{package}` are {host} there and {} on the device", list(device))
            }
        }
    }
}

impl Error {
    /// What is wrong, and what to do about it. The second is empty where the first already says it, or nothing general
    /// can be said.
    fn words(&self) -> (String, Cow<'static, str>) {
        match self {
            Self::NoDeviceCompiler { rejected } => {
                let rejected: Vec<_> = rejected.iter().map(Rejected::to_string).collect();
                let rejected = if rejected.is_empty() { "no rustc found".into() } else { rejected.join("; ") };
                (
                    format!(
                        "no device compiler, that is a rustc {MINIMUM} or newer with its library sources ({rejected})"
                    ),
                    "run `cargo optix setup`".into(),
                )
            }
            Self::SwitchedOff => ("OPTIX_RUSTC=none switches device code off".into(), "unset it to compile it".into()),
            Self::ChosenCompiler(rejected) => {
                (format!("OPTIX_RUSTC can't compile shaders: {rejected}"), "unset it, or name a rustc that can".into())
            }
            Self::UnknownArch { arch, known } => (
                format!("the device compiler has no architecture `{arch}`"),
                format!("it has {}", known.join(", ")).into(),
            ),
            Self::NotAShaderCrate { path, lacks } => {
                let (problem, remedy) = lacks.words();
                (format!("{} is no shader crate: {problem}", path.display()), remedy.into())
            }
            Self::Differs { package, differences } => {
                let differences: Vec<_> = differences.iter().map(Difference::to_string).collect();
                (
                    format!(
                        "host and device would run different code of `{package}`: {} (\"there\" is the workspace that the \
                         program is built in)",
                        differences.join("; ")
                    ),
                    "say what makes the difference in a place that every cargo reads: Cargo.toml, Cargo.lock, or \
                     .cargo/config.toml of the workspace"
                        .into(),
                )
            }
            Self::NeedsStd(needs_std) => (needs_std.problem(), needs_std.remedy().into()),
            Self::OfStd { package, of_std } => (
                format!(
                    "`{package}` uses `{}`, which is of the standard library; the device has `core` alone",
                    of_std.name
                ),
                of_std.instead.into(),
            ),
            Self::Missing(culprit) => (culprit.problem(), culprit.what.remedy().into()),
            Self::Step { doing, status } | Self::Aborted { doing, status } => {
                (format!("{doing} failed ({status})"), "its own messages say why".into())
            }
            Self::Ptx { path, problem } => (format!("{}: {problem}", path.display()), "".into()),
            #[cfg(feature = "nvvm")]
            Self::NoNvvm(rejected) => {
                (format!("no libNVVM ({rejected})"), "run `cargo optix setup --nvvm`, or name one by OPTIX_NVVM".into())
            }
            #[cfg(feature = "nvvm")]
            Self::NoLibdevice { library } => (
                format!("there is no libdevice.10.bc beside {}", library.display()),
                "run `cargo optix setup --nvvm`, or name a libNVVM of a CUDA toolkit by OPTIX_NVVM".into(),
            ),
            Self::Libdevice => (
                "only libNVVM links libdevice".into(),
                "choose it (`--codegen nvvm`, `Codegen::Nvvm`), or leave `libdevice` off".into(),
            ),
            Self::NoRustCuda(unusable) => {
                (format!("no code generator rustc_codegen_nvvm: {unusable}"), crate::rust_cuda::INSTALL.into())
            }
            #[cfg(feature = "nvvm")]
            Self::Nvvm(failure) => (failure.to_string(), "".into()),
            #[cfg(feature = "nvvm")]
            Self::Refused(refusal) => (refusal.to_string(), "".into()),
            Self::Output { of, reason } => (format!("unexpected output of {of}: {reason}"), "".into()),
            Self::Io { doing, source } => (format!("{doing}: {source}"), "".into()),
        }
    }

    /// What to do about it, if something general can be said.
    pub fn remedy(&self) -> Option<Cow<'static, str>> {
        Some(self.words().1).filter(|remedy| !remedy.is_empty())
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (problem, remedy) = self.words();
        f.write_str(&problem)?;
        if remedy.is_empty() { Ok(()) } else { write!(f, "; {remedy}") }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Io { source, .. } => Some(source),
            _ => None,
        }
    }
}

/// Adds to an I/O result what was being done.
pub(crate) trait Doing<T> {
    fn doing(self, what: impl FnOnce() -> String) -> Result<T, Error>;
}

impl<T> Doing<T> for std::io::Result<T> {
    fn doing(self, what: impl FnOnce() -> String) -> Result<T, Error> {
        self.map_err(|source| Error::Io { doing: what(), source })
    }
}
