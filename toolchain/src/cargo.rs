//! Running cargo inside of cargo.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::compiler::LIBRARY_PATH;
use crate::error::{Doing, Error};

/// The cargo that runs this program, or else the one in `PATH`.
pub(crate) fn program() -> PathBuf {
    std::env::var_os("CARGO").filter(|cargo| !cargo.is_empty()).unwrap_or_else(|| "cargo".into()).into()
}

/// Where cargo runs and with which general options. Together they decide which configuration files it reads.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    /// Cargo reads configuration files from here upwards.
    pub dir: PathBuf,
    /// Options for every cargo, such as `--config` of the outer one.
    pub options: Vec<OsString>,
}

impl Place {
    /// A cargo for the package with this manifest.
    pub fn cargo(&self, subcommand: &str, manifest: &Path) -> Command {
        let mut command = command(&self.dir);
        command.arg(subcommand).arg("--manifest-path").arg(manifest).args(&self.options);
        command
    }
}

/// Options that were given to a cargo in `dir`, made fit for one that runs in another folder: paths of configuration
/// files become absolute.
pub(crate) fn elsewhere(options: &[OsString], dir: &Path) -> Vec<OsString> {
    let file = |value: &str| Some(dir.join(value).into_os_string()).filter(|file| Path::new(file).is_file());
    let mut is_setting = false;
    let option = |option: &OsString| {
        let text = option.to_string_lossy();
        let found = match (std::mem::replace(&mut is_setting, text == "--config"), text.strip_prefix("--config=")) {
            (true, _) => file(&text),
            (false, value) => value.and_then(file).map(|file| {
                let mut option = OsString::from("--config=");
                option.push(file);
                option
            }),
        };
        found.unwrap_or_else(|| option.clone())
    };
    options.iter().map(option).collect()
}

/// A cargo that does not inherit anything from the outer build: no flags, wrappers (such as clippy's), target or
/// package.
///
/// It keeps what says how to reach registries, how many jobs to run, what profiles are and how the host links, and reads
/// configuration files from the folder `dir` upwards as usual.
pub(crate) fn command(dir: &Path) -> Command {
    let mut command = Command::new(program());
    command.current_dir(dir);
    let in_build_script = std::env::var_os("OUT_DIR").is_some();
    for (name, _) in std::env::vars_os() {
        if name.to_str().is_some_and(|name| belongs_to_outer_build(name, in_build_script)) {
            command.env_remove(name);
        }
    }
    if let Some(path) = std::env::var_os(LIBRARY_PATH) {
        match users_library_path(&path) {
            Some(path) => command.env(LIBRARY_PATH, path),
            None => command.env_remove(LIBRARY_PATH),
        };
    }
    command
}

fn belongs_to_outer_build(name: &str, in_build_script: bool) -> bool {
    const KEPT: &[&str] = &[
        "CARGO_HOME",
        "CARGO_MAKEFLAGS",
        "CARGO_BUILD_JOBS",
        "CARGO_CREDENTIAL_ALIAS_",
        "CARGO_HTTP_",
        "CARGO_NET_",
        "CARGO_PROFILE_",
        "CARGO_REGISTRIES_",
        "CARGO_REGISTRY_",
        "CARGO_RESOLVER_",
        "CARGO_SOURCE_",
        "CARGO_TERM_",
    ];
    const REMOVED: &[&str] = &["CARGO", "RUSTC", "RUSTFLAGS", "RUSTDOC", "CLIPPY_", "DEP_", "OUT_DIR"];
    // Cargo sets these for build scripts but not for compilers. If they stayed, `option_env!` would see them on the
    // device and not on the host.
    const OF_BUILD_SCRIPTS: &[&str] = &["TARGET", "HOST", "NUM_JOBS", "OPT_LEVEL", "DEBUG", "PROFILE"];
    let starts = |prefixes: &[&str]| prefixes.iter().any(|prefix| name.starts_with(prefix));
    // `CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_LINKER`: how build scripts are linked, and programs run, on this machine.
    let is_of_host = name.starts_with("CARGO_TARGET_") && (name.ends_with("_LINKER") || name.ends_with("_RUNNER"));
    starts(REMOVED) && !starts(KEPT) && !is_of_host || in_build_script && OF_BUILD_SCRIPTS.contains(&name)
}

/// The folders of a library path without those that cargo has added: its target directory and the libraries of its own
/// compiler, which another compiler must not load.
fn users_library_path(path: &OsStr) -> Option<OsString> {
    let is_cargos = |dir: &PathBuf| {
        let is_of_compiler = dir.join("rustlib").is_dir() || dir.components().any(|part| part.as_os_str() == "rustlib");
        is_of_compiler || dir.ancestors().any(|dir| dir.join("CACHEDIR.TAG").is_file())
    };
    let users: Vec<PathBuf> = std::env::split_paths(path).filter(|dir| !is_cargos(dir)).collect();
    std::env::join_paths(users).ok().filter(|path| !path.is_empty())
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
        for name in [
            "RUSTC_WORKSPACE_WRAPPER",
            "RUSTFLAGS",
            "CARGO_ENCODED_RUSTFLAGS",
            "CARGO_TARGET_DIR",
            "CARGO_PKG_NAME",
            "CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_RUSTFLAGS",
            "CARGO_UNSTABLE_BUILD_STD",
        ] {
            assert!(belongs_to_outer_build(name, false), "{name}");
        }
        for name in [
            "CARGO_HOME",
            "CARGO_NET_OFFLINE",
            "CARGO_MAKEFLAGS",
            "CARGO_PROFILE_DEV_OVERFLOW_CHECKS",
            "CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_LINKER",
            "PATH",
            "HOME",
            "OPTIX_RUSTC",
            "RUST_BACKTRACE",
            "DEBUG",
        ] {
            assert!(!belongs_to_outer_build(name, false), "{name}");
        }
        assert!(belongs_to_outer_build("DEBUG", true) && !belongs_to_outer_build("DEBUGINFOD_URLS", true));
    }

    #[test]
    fn files_of_settings_are_found_from_elsewhere() {
        let dir = Path::new(env!("CARGO_MANIFEST_DIR"));
        let given =
            ["--offline", "--config", "Cargo.toml", "--config=Cargo.toml", "Cargo.toml", "--config=a.b=1", "--config"];
        let file = dir.join("Cargo.toml").display().to_string();
        let with = format!("--config={file}");
        let expected = ["--offline", "--config", &file, &with, "Cargo.toml", "--config=a.b=1", "--config"];
        assert_eq!(elsewhere(&given.map(OsString::from), dir), expected.map(OsString::from));
    }

    #[test]
    fn a_library_path_keeps_what_is_the_users() {
        let sysroot = "/opt/rust/lib/rustlib/x86_64-unknown-linux-gnu/lib";
        let path = std::env::join_paths([sysroot, "/opt/llvm/lib"]).expect("no separators");
        assert_eq!(users_library_path(&path), Some("/opt/llvm/lib".into()));
        assert_eq!(users_library_path(OsStr::new(sysroot)), None);
    }
}
