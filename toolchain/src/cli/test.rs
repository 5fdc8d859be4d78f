//! `cargo optix test`

use std::process::{Command, ExitCode};

use super::{Failure, Outcome, cargo, libraries, setup};

/// The environment variable that tells tests that they may use the GPU.
const GPU_SWITCH: &str = "OPTIX_TEST_GPU";

pub(super) fn run(args: &[String]) -> Outcome {
    // Without a device compiler most tests still run. The error is printed, and each test decides what it does.
    if let Err(failure) = setup::run() {
        eprintln!("warning: {failure}");
    }
    let gpu = libraries::open(libraries::OPTIX).is_ok();
    let mut command = Command::new(cargo());
    command.args(["test", "--workspace"]).args(args);
    // The workspace's alias uses `cargo run`, which sets variables that describe the package of this command. Tests
    // must not see them.
    for (name, _) in std::env::vars_os() {
        let of_this_package = |name: &str| name.starts_with("CARGO_PKG_") || name.starts_with("CARGO_MANIFEST_");
        if name.to_str().is_some_and(of_this_package) {
            command.env_remove(name);
        }
    }
    if gpu {
        command.env(GPU_SWITCH, "1");
    }
    let status =
        command.status().map_err(|e| Failure(format!("cannot run cargo: {e}; install it from https://rustup.rs")))?;
    if !gpu {
        say!("GPU tests: not run, no {}", libraries::OPTIX);
    }
    // There is no exit code if a signal ended the process.
    let code = status.code().map_or(1, |code| u8::try_from(code).unwrap_or(1));
    Ok(ExitCode::from(code))
}
