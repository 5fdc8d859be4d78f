//! `cargo optix test`

use std::process::{Command, ExitCode};

use super::{Failure, Outcome, cargo, libraries, setup};

/// What tests look at to learn that they may use the GPU.
const GPU_SWITCH: &str = "OPTIX_TEST_GPU";

pub(super) fn run(args: &[String]) -> Outcome {
    // Without a device compiler most tests still run; what failed is said, and the tests decide.
    if let Err(failure) = setup::run() {
        eprintln!("warning: {failure}");
    }
    let gpu = libraries::open(libraries::OPTIX).is_ok();
    let mut command = Command::new(cargo());
    command.args(["test", "--workspace"]).args(args);
    // `cargo run`, which the workspace's alias for this command is, describes the package of this command.
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
    // No code: ended by a signal.
    let code = status.code().map_or(1, |code| u8::try_from(code).unwrap_or(1));
    Ok(ExitCode::from(code))
}
