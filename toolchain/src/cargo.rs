//! Running cargo inside of cargo.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::error::{Doing, Error};

/// The cargo that runs this program, or else the one in `PATH`.
pub(crate) fn program() -> PathBuf {
    std::env::var_os("CARGO").filter(|cargo| !cargo.is_empty()).unwrap_or_else(|| "cargo".into()).into()
}

/// A cargo that knows nothing of the outer build: not its flags, wrappers (clippy), profile, target or package.
///
/// It keeps what says how to reach registries and how many jobs to run, and reads configuration files from the folder
/// `dir` upwards as usual.
pub(crate) fn command(dir: &Path) -> Command {
    let mut command = Command::new(program());
    command.current_dir(dir);
    for (name, _) in std::env::vars_os() {
        if name.to_str().is_some_and(belongs_to_outer_build) {
            command.env_remove(name);
        }
    }
    command
}

fn belongs_to_outer_build(name: &str) -> bool {
    const KEPT: &[&str] = &[
        "CARGO_HOME",
        "CARGO_MAKEFLAGS",
        "CARGO_BUILD_JOBS",
        "CARGO_NET_",
        "CARGO_HTTP_",
        "CARGO_REGISTRY_",
        "CARGO_REGISTRIES_",
        "CARGO_SOURCE_",
        "CARGO_TERM_",
    ];
    const REMOVED: &[&str] =
        &["CARGO", "RUSTC", "RUSTFLAGS", "RUSTDOC", "CLIPPY_", "DEP_", "OUT_DIR", "LD_LIBRARY_PATH"];
    let starts = |prefixes: &[&str]| prefixes.iter().any(|prefix| name.starts_with(prefix));
    starts(REMOVED) && !starts(KEPT)
}

/// Runs a command whose diagnostics go to standard error. Its standard output is dropped: in a build script that is
/// the channel to the outer cargo.
pub(crate) fn run(command: &mut Command, doing: &str) -> Result<(), Error> {
    let program = command.get_program().to_os_string();
    let status = command.stdout(Stdio::null()).status().doing(|| cannot_run(&program))?;
    if status.success() { Ok(()) } else { Err(Error::Step { doing: doing.to_string(), status }) }
}

/// Runs a command and returns what it prints.
pub(crate) fn read(command: &mut Command, doing: &str) -> Result<String, Error> {
    let program = command.get_program().to_os_string();
    let output = command.stderr(Stdio::inherit()).output().doing(|| cannot_run(&program))?;
    if !output.status.success() {
        return Err(Error::Step { doing: doing.to_string(), status: output.status });
    }
    String::from_utf8(output.stdout).map_err(|e| Error::Output { of: doing.to_string(), reason: e.to_string() })
}

fn cannot_run(program: &OsString) -> String {
    format!("cannot run {}", program.to_string_lossy())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_outer_build_stays_outside() {
        for name in
            ["RUSTC_WORKSPACE_WRAPPER", "RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS", "CARGO_TARGET_DIR", "CARGO_PKG_NAME"]
        {
            assert!(belongs_to_outer_build(name), "{name}");
        }
        for name in
            ["CARGO_HOME", "CARGO_NET_OFFLINE", "CARGO_MAKEFLAGS", "PATH", "HOME", "OPTIX_RUSTC", "RUST_BACKTRACE"]
        {
            assert!(!belongs_to_outer_build(name), "{name}");
        }
    }
}
