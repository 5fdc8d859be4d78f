//! The command line of `cargo optix`, with a module for each subcommand.

/// As `println!`, but it ends the process without a message when nobody reads the output any more, as in `cargo optix
/// doctor | head`.
macro_rules! say {
    ($($text:tt)*) => { $crate::cli::say(format_args!($($text)*)) };
}

mod build;
mod doctor;
mod inspect;
mod libraries;
mod new;
mod options;
mod setup;
mod test;
mod verify;
mod wheels;

use std::fmt;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Compile, check and test OptiX shaders written in Rust.
#[derive(Parser)]
#[command(name = "cargo optix", bin_name = "cargo optix", version)]
struct Arguments {
    #[command(subcommand)]
    command: Action,
}

#[derive(Subcommand)]
enum Action {
    /// Say what this machine can do, and how to get what is missing. Exit code 0 if it can compile shaders.
    Doctor,
    /// Install a device compiler, if there is none.
    Setup {
        /// Also install libNVVM and ptxas, in the version that the driver here takes, into the user's cache folder.
        #[arg(long)]
        nvvm: bool,
    },
    /// Compile shader crates to `target/optix/ptx/CRATE.ptx`.
    ///
    /// Without --crate, every package of the workspace that has `[package.metadata.optix] shaders = true`.
    Build {
        /// The oldest GPU architecture to run on.
        #[arg(long, value_name = "sm_XX", default_value = optix_toolchain::DEFAULT_ARCH)]
        arch: String,
        #[command(flatten)]
        options: options::Options,
    },
    /// Prove that the PTX of shader crates keeps the contracts of their pipelines. Exit code 1 if it does not.
    ///
    /// Compiles them, and compares entries, launch parameters, payloads and trace calls with what the host computes
    /// from the same declarations; finds local memory and calls. Without --crate, every shader crate of the workspace.
    Verify {
        /// The oldest GPU architecture to run on.
        #[arg(long, value_name = "sm_XX", default_value = optix_toolchain::DEFAULT_ARCH)]
        arch: String,
        #[command(flatten)]
        options: options::Options,
        /// A function that may be called instead of inlined, by a part of its path. May be repeated.
        #[arg(long = "allow-function", value_name = "NAME")]
        allowed: Vec<String>,
        /// Print each finding as a JSON object on one line, and nothing else.
        #[arg(long)]
        json: bool,
    },
    /// Say what each program of shader crates costs: PTX size, instructions by class, calls, memory, registers.
    ///
    /// Counts are of PTX, as written; registers and spills are those of `ptxas`, where it is installed, with OptiX's device
    /// functions replaced by loads and stores. Both compare builds; the compile log of OptiX tells what it used.
    Inspect(inspect::How),
    /// Set up, then run every test of the workspace; those that need a GPU too if OptiX is here.
    Test {
        /// Further arguments of `cargo test --workspace`.
        #[arg(last = true, value_name = "ARGS")]
        args: Vec<String>,
    },
    /// Make a project: a shader crate and a host program, which builds and renders.
    New {
        /// The folder to make; its last part names the package.
        path: PathBuf,
    },
}

/// Runs the command that the process was started with.
pub(crate) fn main() -> ExitCode {
    // Cargo runs `cargo-optix optix ..` for an installed `cargo optix ..`. The workspace's alias runs it without the
    // word `optix`.
    let mut args: Vec<_> = std::env::args_os().collect();
    if args.get(1).is_some_and(|word| word == "optix") {
        args.remove(1);
    }
    let outcome = match Arguments::parse_from(args).command {
        Action::Doctor => doctor::run(),
        Action::Setup { nvvm } => {
            setup::run().and_then(|_| if nvvm { wheels::install() } else { Ok(()) }).map(|()| ExitCode::SUCCESS)
        }
        Action::Build { arch, options } => build::run(&arch, &options),
        Action::Verify { arch, options, allowed, json } => verify::run(&verify::How { arch, options, allowed, json }),
        Action::Inspect(how) => inspect::run(&how),
        Action::Test { args } => test::run(&args),
        Action::New { path } => new::run(&path),
    };
    outcome.unwrap_or_else(|failure| {
        eprintln!("error: {failure}");
        ExitCode::FAILURE
    })
}

/// Why a command did not do its work, in one line: what is wrong and what to do.
#[derive(Debug)]
struct Failure(String);

type Outcome = Result<ExitCode, Failure>;

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl From<optix_toolchain::Error> for Failure {
    fn from(error: optix_toolchain::Error) -> Self {
        Self(error.to_string())
    }
}

/// The cargo that runs this command, or else the one in `PATH`.
fn cargo() -> std::ffi::OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// Prints a line to standard output; see the macro of this name.
fn say(line: fmt::Arguments<'_>) {
    use std::io::Write;
    if writeln!(std::io::stdout(), "{line}").is_err() {
        std::process::exit(1);
    }
}

fn current_dir() -> Result<PathBuf, Failure> {
    std::env::current_dir().map_err(|e| Failure(format!("cannot tell the current folder: {e}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        use clap::CommandFactory;
        Arguments::command().debug_assert();
    }

    #[test]
    fn arguments_of_test_follow_two_dashes() {
        let parsed = Arguments::try_parse_from(["cargo optix", "test", "--", "-p", "x", "--", "--nocapture"]);
        assert!(
            matches!(parsed.map(|p| p.command), Ok(Action::Test { args }) if args == ["-p", "x", "--", "--nocapture"])
        );
    }
}
