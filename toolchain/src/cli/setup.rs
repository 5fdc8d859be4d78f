//! `cargo optix setup`

use std::path::Path;
use std::process::Command;

use optix_toolchain::{DeviceCompiler, Error, MINIMUM, Release};

use super::Failure;

/// Debian's package of a recent compiler, and that of its library sources.
const PACKAGES: [&str; 2] = ["rustc-web", "rust-web-src"];

/// Makes sure that there is a device compiler.
pub(super) fn run() -> Result<DeviceCompiler, Failure> {
    match DeviceCompiler::find() {
        Ok(compiler) => {
            say!("device compiler: {}", describe(&compiler));
            return Ok(compiler);
        }
        Err(Error::NoDeviceCompiler { .. }) => {}
        Err(error) => return Err(error.into()),
    }
    let mut failed = Vec::new();
    for (name, install) in [("apt-get", apt as fn() -> Result<(), String>), ("rustup", rustup)] {
        match install() {
            Ok(()) => match DeviceCompiler::find() {
                Ok(compiler) => {
                    say!("device compiler: {}", describe(&compiler));
                    return Ok(compiler);
                }
                Err(Error::NoDeviceCompiler { rejected }) => {
                    let rejected: Vec<_> = rejected.iter().map(ToString::to_string).collect();
                    failed.push(format!("{name}: done, but {}", rejected.join(", and ")));
                }
                Err(error) => failed.push(format!("{name}: {error}")),
            },
            Err(reason) => failed.push(format!("{name}: {reason}")),
        }
    }
    Err(Failure(format!("no device compiler could be installed ({}); {}", failed.join("; "), by_hand())))
}

/// What the user can do.
fn by_hand() -> String {
    format!(
        "by hand: `rustup component add rust-src`, with rustup of https://rustup.rs and a way to static.rust-lang.org; or on Debian \
         `{}` as root; or another rustc {MINIMUM} or newer with its library sources, which OPTIX_RUSTC can name",
        apt_command()
    )
}

/// Describes a device compiler in one line.
pub(super) fn describe(compiler: &DeviceCompiler) -> String {
    format!("{}, rustc {}, LLVM {}", compiler.rustc.display(), compiler.release, compiler.llvm)
}

fn apt_command() -> String {
    format!("apt-get install {}", PACKAGES.join(" "))
}

fn apt() -> Result<(), String> {
    if !Path::new("/usr/bin/apt-get").exists() {
        return Err("not here".into());
    }
    if !is_root() {
        return Err(format!("needs root: `sudo {}`", apt_command()));
    }
    if !apt_has_candidate() {
        show(Command::new("apt-get").args(["-q", "update"]))?;
    }
    if !apt_has_candidate() {
        return Err(format!("{} {MINIMUM} or newer is not in this system's package lists", PACKAGES[0]));
    }
    // No package that is installed is removed for it: `rustc-web` conflicts with `rustc`.
    show(Command::new("apt-get").args(["-q", "install", "-y", "--no-install-recommends", "--no-remove"]).args(PACKAGES))
}

/// Whether apt's package lists have both packages, new enough.
fn apt_has_candidate() -> bool {
    PACKAGES.iter().all(|package| {
        let output = Command::new("apt-cache").args(["policy", package]).env("LC_ALL", "C").output();
        let text = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
        let candidate = text.lines().find_map(|line| line.trim().strip_prefix("Candidate:"));
        candidate.and_then(Release::parse).is_some_and(|release| release >= MINIMUM)
    })
}

fn rustup() -> Result<(), String> {
    let Ok(output) = Command::new("rustup").args(["show", "active-toolchain"]).output() else {
        return Err("not here".into());
    };
    if !output.status.success() {
        return Err("no active toolchain: `rustup default stable`".into());
    }
    show(Command::new("rustup").args(["component", "add", "rust-src"]))
}

/// Prints a command and runs it; its output is shown.
pub(super) fn show(command: &mut Command) -> Result<(), String> {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    let line = words.map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ");
    say!("running: {line}");
    match command.env("DEBIAN_FRONTEND", "noninteractive").status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("`{line}` failed ({status})")),
        Err(e) => Err(format!("cannot run `{line}`: {e}")),
    }
}

fn is_root() -> bool {
    let output = Command::new("id").arg("-u").output();
    output.is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}
