//! What can go wrong, each with what to do about it.

use std::fmt;
use std::path::PathBuf;
use std::process::ExitStatus;

use crate::compiler::{MINIMUM, Rejected};
use crate::messages::{NeedsStd, OfStd};
use crate::missing::Culprit;
use crate::ptx;

/// Why a shader crate was not compiled. `Display` is one line: what is wrong and what to do.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    /// No `rustc` on this machine can compile for the device. Not fatal to a build: the program can run on the CPU.
    NoDeviceCompiler {
        /// The compilers that were looked at, in order, and what each lacks.
        rejected: Vec<Rejected>,
    },
    /// `OPTIX_RUSTC=none`. Not fatal to a build either.
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
        reason: String,
    },
    /// The device build would not be made from what the user's own build is made from.
    Differs {
        /// The shader crate.
        package: String,
        /// What differs, each in words.
        differences: Vec<String>,
    },
    /// A crate needs the standard library.
    NeedsStd(NeedsStd),
    /// The shader crate uses a name of the standard library. The diagnostics went to standard error.
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
    /// Cargo has failed without an error in Rust code: in a build script, or while generating code. Its messages went to
    /// standard error.
    Aborted {
        /// What it was doing.
        doing: String,
        /// How it ended.
        status: ExitStatus,
    },
    /// The shader crate uses what the device does not have.
    Missing(Box<Culprit>),
    /// The PTX can't be loaded by OptiX.
    Ptx {
        /// Where it is.
        path: PathBuf,
        /// What is wrong with it.
        problem: ptx::Problem,
    },
    /// No libNVVM on this machine does.
    #[cfg(feature = "nvvm")]
    NoNvvm(String),
    /// libdevice was asked for, and the code generator is one that can't link it.
    Libdevice,
    /// No `rustc_codegen_nvvm` on this machine does.
    NoRustCuda(String),
    /// libNVVM has failed.
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

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoDeviceCompiler { rejected } => {
                write!(f, "no device compiler, that is a rustc {MINIMUM} or newer with its library sources (")?;
                for (i, one) in rejected.iter().enumerate() {
                    write!(f, "{}{one}", if i == 0 { "" } else { "; " })?;
                }
                f.write_str(if rejected.is_empty() {
                    "no rustc found); run `cargo optix setup`"
                } else {
                    "); run `cargo optix setup`"
                })
            }
            Self::SwitchedOff => f.write_str("OPTIX_RUSTC=none switches device code off; unset it to compile it"),
            Self::ChosenCompiler(rejected) => {
                write!(f, "OPTIX_RUSTC can't compile shaders: {rejected}; unset it, or name a rustc that can")
            }
            Self::UnknownArch { arch, known } => {
                write!(f, "the device compiler has no architecture `{arch}`; it has {}", known.join(", "))
            }
            Self::NotAShaderCrate { path, reason } => {
                write!(f, "{} is no shader crate: {reason}", path.display())
            }
            Self::Differs { package, differences } => write!(
                f,
                "host and device would run different code of `{package}`: {}; \"there\" is the workspace that the program is built \
                 in. Say what makes the difference in a place that every cargo reads: Cargo.toml, Cargo.lock, or \
                 .cargo/config.toml of the workspace",
                differences.join("; ")
            ),
            Self::NeedsStd(needs_std) => write!(f, "{needs_std}"),
            Self::OfStd { package, of_std } => write!(f, "`{package}` uses {of_std}"),
            Self::Missing(culprit) => write!(f, "{culprit}"),
            Self::Step { doing, status } | Self::Aborted { doing, status } => {
                write!(f, "{doing} failed ({status}); its own messages say why")
            }
            Self::Ptx { path, problem } => write!(f, "{}: {problem}", path.display()),
            #[cfg(feature = "nvvm")]
            Self::NoNvvm(reason) => {
                write!(f, "no libNVVM ({reason}); run `cargo optix setup --nvvm`, or name one by OPTIX_NVVM")
            }
            Self::Libdevice => f.write_str(
                "only libNVVM links libdevice: choose it (`--codegen nvvm`, `Codegen::Nvvm`), or leave `libdevice` off",
            ),
            Self::NoRustCuda(reason) => {
                write!(f, "no code generator rustc_codegen_nvvm: {reason}; {}", crate::rust_cuda::INSTALL)
            }
            #[cfg(feature = "nvvm")]
            Self::Nvvm(failure) => write!(f, "{failure}"),
            #[cfg(feature = "nvvm")]
            Self::Refused(refusal) => write!(f, "{refusal}"),
            Self::Output { of, reason } => write!(f, "unexpected output of {of}: {reason}"),
            Self::Io { doing, source } => write!(f, "{doing}: {source}"),
        }
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
