//! How long the build of a small shader crate takes, that of `cargo optix new`, with each generator that is here.
//!
//! `cargo bench -p optix-toolchain --features cli --bench builds [-- REPEATS]`. Wall-clock time, and processor time of all
//! processes, which other work on the machine disturbs less: median, least and most. Linux.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use optix_toolchain::nvvm;

const CASES: [&str; 4] = ["cold, `core` included", "cold, `core` cached", "nothing changed", "source edited"];

/// Seconds.
struct Times {
    wall: f64,
    processors: f64,
}

/// The command with caches and target folder of its own.
struct Optix {
    root: PathBuf,
    /// The user's, whose cache the command does not see.
    nvvm: Option<PathBuf>,
}

impl Optix {
    fn command(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_cargo-optix"));
        command.env("XDG_CACHE_HOME", self.root.join("cache")).env("CARGO_TARGET_DIR", self.root.join("target"));
        command.envs(self.nvvm.iter().map(|nvvm| ("OPTIX_NVVM", nvvm)));
        command.current_dir(&self.root);
        command
    }

    fn build(&self, codegen: &str) -> Times {
        let (start, before) = (Instant::now(), children());
        let output = self.command().args(["build", "--crate", "small/shaders", "--codegen", codegen]).output();
        let output = output.expect("the command runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        Times { wall: start.elapsed().as_secs_f64(), processors: children() - before }
    }

    fn remove(&self, folder: &str) {
        let _ = fs::remove_dir_all(self.root.join(folder));
    }
}

/// Processor time of the processes that this one has waited for, and that they have.
fn children() -> f64 {
    const TICKS_PER_SECOND: f64 = 100.0;
    let stat = fs::read_to_string("/proc/self/stat").expect("this is Linux");
    // Behind the name, which may hold spaces: the fields from the third on.
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
    let ticks = |field: usize| fields[field - 3].parse::<f64>().expect("a number");
    (ticks(16) + ticks(17)) / TICKS_PER_SECOND
}

fn spread(mut values: Vec<f64>) -> String {
    values.sort_by(f64::total_cmp);
    format!("{:.2} s [{:.2}, {:.2}]", values[values.len() / 2], values[0], values[values.len() - 1])
}

fn main() {
    let repeats: usize = std::env::args().find_map(|arg| arg.parse().ok()).unwrap_or(3);
    let root = Path::new(env!("CARGO_TARGET_TMPDIR")).join("builds");
    let optix = Optix { root, nvvm: nvvm::choose().ok().map(|library| library.path) };
    optix.remove("");
    fs::create_dir_all(&optix.root).expect("writable");
    let made = optix.command().args(["new", "small"]).status();
    assert!(made.is_ok_and(|status| status.success()), "`cargo optix new` works");
    // The versions that are downloaded already.
    let lock = Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.lock");
    fs::copy(lock, optix.root.join("small/Cargo.lock")).expect("the workspace has a lock file");
    let source = optix.root.join("small/shaders/src/lib.rs");

    for codegen in ["rustc", "nvvm"].into_iter().filter(|name| *name == "rustc" || optix.nvvm.is_some()) {
        let mut results: [Vec<Times>; CASES.len()] = Default::default();
        for _ in 0..repeats {
            optix.remove("cache");
            for times in &mut results[..2] {
                optix.remove("target");
                times.push(optix.build(codegen));
            }
            results[2].push(optix.build(codegen));
            let text = fs::read_to_string(&source).expect("readable");
            fs::write(&source, text + "// edited\n").expect("writable");
            results[3].push(optix.build(codegen));
        }
        for (case, times) in CASES.iter().zip(results) {
            let wall = spread(times.iter().map(|times| times.wall).collect());
            let processors = spread(times.iter().map(|times| times.processors).collect());
            println!("{codegen:6} {case:24} {wall}, processors {processors}");
        }
    }
    let load = fs::read_to_string("/proc/loadavg").unwrap_or_default();
    println!("load of the machine: {load}");
}
