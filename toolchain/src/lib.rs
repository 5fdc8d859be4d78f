//! Compiles a shader crate, an ordinary `#![no_std]` library written with `optix-device-rs`, to one PTX file.
//!
//! Stock `rustc` does it: no CUDA toolkit, no OptiX SDK and no custom code generator. A program needs one line in its
//! `build.rs`:
//!
//! ```no_run
//! optix_toolchain::shaders("shaders"); // the shader crate's folder, relative to the package
//! ```
//!
//! The PTX is then `OUT_DIR/<crate_name>.ptx`, and the environment variable `OPTIX_PTX_<crate_name>` that the program
//! is compiled with holds its absolute path: `include_str!(env!("OPTIX_PTX_my_shaders"))`. [`Shaders`] is the same with
//! options.
//!
//! # Where there is no device compiler
//!
//! The device compiler is any `rustc` with the sources of its standard library ([`DeviceCompiler::find`]);
//! `cargo optix setup` installs one. Where none is found, the build goes on with one warning and an empty PTX file: the
//! program runs on the CPU. A compile error in the shader crate does fail the build. The environment variable
//! `OPTIX_RUSTC` names the device compiler to use; `OPTIX_RUSTC=none` compiles nothing for the device.
//!
//! # How
//!
//! | step | module |
//! | --- | --- |
//! | find a `rustc` that has library sources and the PTX back end | `compiler` |
//! | compile `core`, and `alloc` where a crate names it, for `nvptx64-nvidia-cuda`: once per compiler and flags | `sysroot` |
//! | find out what the host program is made from: packages, patches, features, checks | `original`, `outer`, `units` |
//! | write a wrapper package around the shader crate, so that its manifest and lock stay untouched, with all of that | `wrapper` |
//! | compare what both resolve to; refuse where it differs | `original` |
//! | replace software `sqrt`, `floor`, `fma` .. by instructions | `libm` |
//! | run cargo on the wrapper where the outer cargo runs, so that configuration counts, but without the outer build's environment | `cargo` |
//! | show what `rustc` says, and name a crate that needs the standard library | `messages` |
//! | check that the PTX has entries and nothing that OptiX does not run | [`mod@ptx`] |
//! | if it has, find the crate, function and line that asks for it | `missing` |
//!
//! The module `verify`, of the feature `cli`, goes further: for `cargo optix verify` it compares the PTX with what the host
//! computes from the same `pipeline!`. The module `inspect` is behind `cargo optix inspect`: what programs cost.
//! [`json`] reads what cargo prints and writes what `cargo optix` prints as JSON.
//!
//! The device's `core` is in the user's cache folder ([`cache()`]), or with the rest where that can't be written. Everything else is
//! under `<target directory>/optix`, which `cargo clean` removes.

mod build_script;
mod cache;
mod cargo;
mod compiler;
mod dep_info;
mod device_build;
mod error;
pub mod json;
mod libm;
mod lock;
mod messages;
mod metadata;
mod missing;
#[cfg(feature = "nvvm")]
pub mod nvvm;
mod options;
mod original;
mod outer;
pub mod ptx;
pub mod rust_cuda;
mod sysroot;
mod units;
mod util;
// These are left out of build scripts, which would take longer to compile with them.
#[cfg(feature = "cli")]
pub mod inspect;
#[cfg(feature = "cli")]
pub mod verify;
mod wrapper;

pub use cache::cache;
pub use compiler::{Candidate, DeviceCompiler, MINIMUM, Rejected, Release, Why};
pub use device_build::Built;
pub use error::{Difference, Error, Lacking};
pub use messages::{NeedsStd, OfStd};
pub use metadata::{Package, Workspace};
pub use missing::{Culprit, Missing, SourceLocation};
pub use options::{Codegen, DEFAULT_ARCH, Shaders};

/// Compiles the shader crate in `path` with the default [options](Shaders). To be called from a `build.rs`.
///
/// `path` is relative to the folder of the package that is being built. On failure this prints the reason the way
/// cargo expects it and ends the process with exit code 1, because a build script can do nothing else.
///
/// ```no_run
/// // In build.rs:
/// optix_toolchain::shaders("shaders");
/// ```
pub fn shaders(path: impl AsRef<std::path::Path>) {
    Shaders::new(path).compile();
}
