//! Finds the `rustc` that compiles shaders.
//!
//! Any stock `rustc` can write PTX. What most installations lack is the source of `core`, because no `core` is
//! distributed for `nvptx64-nvidia-cuda`.

use std::fmt;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::error::Error;

/// The value of `OPTIX_RUSTC` that stands for no compiler.
const NONE: &str = "none";

/// The environment variable with the folders in which the system looks for libraries first. For build scripts, cargo
/// adds the folder of its own compiler, whose libraries another compiler must not load.
pub(crate) const LIBRARY_PATH: &str = "LD_LIBRARY_PATH";

/// The target triple of device code.
pub(crate) const TARGET: &str = "nvptx64-nvidia-cuda";

/// The oldest device compiler: the version this workspace's crates are written for.
pub const MINIMUM: Release = Release { major: 1, minor: 95 };

/// The version of a `rustc`, as far as it matters here.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Release {
    /// 1 in 1.96.0
    pub major: u32,
    /// 96 in 1.96.0
    pub minor: u32,
}

impl Release {
    /// Reads `1.96.0` or `1.97.0-nightly`.
    pub fn parse(text: &str) -> Option<Self> {
        let mut numbers = text.trim().split('.');
        Some(Self { major: numbers.next()?.parse().ok()?, minor: numbers.next()?.parse().ok()? })
    }
}

impl fmt::Display for Release {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.major, self.minor)
    }
}

/// A `rustc` that can compile shaders: it is new enough, has the PTX back end, and has its library sources.
#[derive(Clone, Debug)]
pub struct DeviceCompiler {
    /// The `rustc` to run.
    pub rustc: PathBuf,
    /// What `rustc -vV` prints; identifies the compiler.
    pub version: String,
    /// Its version.
    pub release: Release,
    /// The version of its LLVM, such as `22.1.8`.
    pub llvm: String,
    /// The folder that holds `core`, `alloc` and `std`.
    pub library: PathBuf,
    /// The architectures that it can generate code for: `sm_75` and so on.
    pub archs: Vec<String>,
}

/// A `rustc` to look at, and where it was found.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// The program.
    pub rustc: PathBuf,
    /// How it was found, for people: "the rustc in use".
    pub origin: &'static str,
}

/// A `rustc` that can't compile shaders.
#[derive(Clone, Debug)]
pub struct Rejected {
    /// The program.
    pub rustc: PathBuf,
    /// What it lacks.
    pub why: Why,
}

/// What a `rustc` lacks.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Why {
    /// It can't be run, or prints no version.
    DoesNotRun(String),
    /// It is older than [`MINIMUM`].
    TooOld(Release),
    /// It has no PTX back end.
    NoTarget,
    /// The sources of its standard library are not installed; they belong here.
    NoSources(PathBuf),
}

impl fmt::Display for Rejected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ", self.rustc.display())?;
        match &self.why {
            Why::DoesNotRun(reason) => write!(f, "does not run: {reason}"),
            Why::TooOld(release) => write!(f, "is {release}"),
            Why::NoTarget => write!(f, "has no {TARGET} back end"),
            Why::NoSources(_) => f.write_str("has no library sources"),
        }
    }
}

impl DeviceCompiler {
    /// The device compiler: the one that `OPTIX_RUSTC` names, or else the first of the other
    /// [candidates](Candidate::all) that can do it. `OPTIX_RUSTC=none` switches device code off.
    ///
    /// ```no_run
    /// let compiler = optix_toolchain::DeviceCompiler::find()?;
    /// println!("{} (LLVM {})", compiler.rustc.display(), compiler.llvm);
    /// # Ok::<(), optix_toolchain::Error>(())
    /// ```
    pub fn find() -> Result<Self, Error> {
        // If `OPTIX_RUSTC` names a compiler that can't be used, that is an error, and no other compiler is tried.
        if let Some(chosen) = chosen() {
            if chosen == Path::new(NONE) {
                return Err(Error::SwitchedOff);
            }
            return Self::check(&chosen).map_err(Error::ChosenCompiler);
        }
        let mut rejected = Vec::new();
        for candidate in Candidate::all() {
            match Self::check(&candidate.rustc) {
                Ok(compiler) => return Ok(compiler),
                Err(why) => rejected.push(why),
            }
        }
        Err(Error::NoDeviceCompiler { rejected })
    }

    /// Whether this `rustc` can compile shaders.
    pub fn check(rustc: &Path) -> Result<Self, Rejected> {
        Self::of_age(rustc, MINIMUM)
    }

    /// Checks that this `rustc` is of the release `oldest` or newer, and can compile device code.
    pub(crate) fn of_age(rustc: &Path, minimum: Release) -> Result<Self, Rejected> {
        let reject = |why| Rejected { rustc: rustc.to_path_buf(), why };
        let version = output(rustc, &["-vV"]).map_err(|e| reject(Why::DoesNotRun(e)))?;
        let field = |name: &str| version.lines().find_map(|line| line.strip_prefix(name)).map(str::trim);
        let release = field("release:")
            .and_then(Release::parse)
            .ok_or_else(|| reject(Why::DoesNotRun("it prints no release".into())))?;
        if release < minimum {
            return Err(reject(Why::TooOld(release)));
        }
        let sysroot = output(rustc, &["--print", "sysroot"]).map_err(|e| reject(Why::DoesNotRun(e)))?;
        let library = sources_of(Path::new(sysroot.trim()));
        if !library.join("core/src/lib.rs").is_file() {
            return Err(reject(Why::NoSources(library)));
        }
        // A rustc whose LLVM was built without the PTX back end knows the target and lists no CPU for it.
        let cpus = output(rustc, &["--print", "target-cpus", "--target", TARGET]).unwrap_or_default();
        let archs = architectures(&cpus);
        if archs.is_empty() {
            return Err(reject(Why::NoTarget));
        }
        let llvm = field("LLVM version:").unwrap_or("unknown").to_string();
        Ok(Self { rustc: rustc.to_path_buf(), release, llvm, library, archs, version })
    }

    /// Makes a cargo use this compiler.
    pub(crate) fn used_by<'c>(&self, cargo: &'c mut Command) -> &'c mut Command {
        cargo.env("RUSTC", &self.rustc).env("RUSTC_BOOTSTRAP", "1");
        // An empty value also switches off a wrapper that a configuration file names.
        cargo.env("RUSTC_WRAPPER", "").env("RUSTC_WORKSPACE_WRAPPER", "")
    }

    /// The target triple of the machine that it runs on.
    #[cfg(feature = "cli")]
    pub(crate) fn host(&self) -> Result<&str, Error> {
        self.version.lines().find_map(|line| line.strip_prefix("host: ")).ok_or_else(|| Error::Output {
            of: format!("{} -vV", self.rustc.display()),
            reason: "there is no line `host:`".into(),
        })
    }

    /// The edition that this compiler's `core` is written in.
    pub fn core_edition(&self) -> Result<String, Error> {
        let manifest = self.library.join("core/Cargo.toml");
        let text = crate::util::read(&manifest)?;
        let edition = text.lines().find_map(|line| line.trim().strip_prefix("edition = \"")?.strip_suffix('"'));
        Ok(edition.unwrap_or("2024").to_string())
    }
}

impl Candidate {
    /// The compilers to try, best first: the one in use, those that rustup has installed (stable ones first, newer
    /// before older), and the distribution's. If `OPTIX_RUSTC` is set, only the one that it names.
    pub fn all() -> Vec<Self> {
        if let Some(rustc) = chosen() {
            return vec![Self { rustc, origin: "OPTIX_RUSTC" }];
        }
        let mut all = vec![Self { rustc: behind_proxy(host_rustc()), origin: "the rustc in use" }];
        all.extend(rustup_toolchains().into_iter().map(|rustc| Self { rustc, origin: "a rustup toolchain" }));
        all.extend(distribution().into_iter().map(|rustc| Self { rustc, origin: "the distribution's rustc" }));
        let mut seen: Vec<PathBuf> = Vec::new();
        all.retain(|candidate| {
            let path = resolve(&candidate.rustc);
            let new = !seen.contains(&path);
            seen.push(path);
            new
        });
        all
    }
}

/// The GPU architectures in a list of `rustc --print target-cpus`, oldest first: those that OptiX knows, and none of the
/// variants (`sm_90a`) whose PTX runs on that one generation only.
fn architectures(cpus: &str) -> Vec<String> {
    const OLDEST: u32 = 50;
    let number = |word: &str| word.strip_prefix("sm_")?.parse().ok();
    let mut numbers: Vec<u32> = cpus.split_whitespace().filter_map(number).collect();
    numbers.retain(|number| *number >= OLDEST);
    numbers.sort_unstable();
    numbers.iter().map(|number| format!("sm_{number}")).collect()
}

/// The program that a rustup proxy in `PATH` runs. Its path changes with the toolchain, which the proxy's does not.
fn behind_proxy(rustc: PathBuf) -> PathBuf {
    let name = format!("rustc{}", std::env::consts::EXE_SUFFIX);
    let sysroot = output(&rustc, &["--print", "sysroot"]);
    let real = sysroot.map(|sysroot| Path::new(sysroot.trim()).join("bin").join(name));
    real.ok().filter(|real| real.is_file()).unwrap_or(rustc)
}

/// Where the library sources of a compiler with this sysroot belong.
pub(crate) fn sources_of(sysroot: &Path) -> PathBuf {
    sysroot.join("lib/rustlib/src/rust/library")
}

/// The compiler of the host's code: cargo names it to build scripts in `RUSTC`.
pub(crate) fn host_rustc() -> PathBuf {
    std::env::var_os("RUSTC").filter(|rustc| !rustc.is_empty()).unwrap_or_else(|| "rustc".into()).into()
}

fn chosen() -> Option<PathBuf> {
    let chosen = std::env::var_os("OPTIX_RUSTC").filter(|rustc| !rustc.is_empty()).map(PathBuf::from)?;
    // Cargo, which runs it, does so in another folder; a name alone is looked for in `PATH`.
    if chosen.components().count() == 1 { Some(chosen) } else { std::path::absolute(chosen).ok() }
}

/// Files and small folders that change when a compiler or its sources are installed. A build that found no device
/// compiler depends on them. (If it named the missing file itself, cargo would rebuild the program every time.)
pub(crate) fn installation_records() -> Vec<PathBuf> {
    let mut records = vec![PathBuf::from("/var/lib/dpkg/status")];
    records.extend(rustup_home().map(|home| home.join("update-hashes")));
    let candidates = Candidate::all();
    let roots = candidates.iter().filter_map(|candidate| candidate.rustc.parent()?.parent());
    records.extend(roots.map(|root| root.join("lib/rustlib/components")));
    records.retain(|record| record.exists());
    records
}

fn rustup_home() -> Option<PathBuf> {
    let home = std::env::var_os("RUSTUP_HOME").map(PathBuf::from);
    home.or_else(|| std::env::home_dir().map(|home| home.join(".rustup")))
}

/// The compilers of the installed rustup toolchains. The real programs, not rustup's proxies: those may download.
fn rustup_toolchains() -> Vec<PathBuf> {
    let Some(toolchains) = rustup_home().and_then(|home| std::fs::read_dir(home.join("toolchains")).ok()) else {
        return Vec::new();
    };
    let mut roots: Vec<PathBuf> = toolchains.flatten().map(|entry| entry.path()).collect();
    roots.sort_by_key(|root| {
        let name = root.file_name().unwrap_or_default().to_string_lossy().into_owned();
        (!name.starts_with("stable"), std::cmp::Reverse(Release::parse(&name)))
    });
    roots.iter().map(|root| root.join("bin").join(format!("rustc{}", std::env::consts::EXE_SUFFIX))).collect()
}

/// Debian has one compiler in `/usr/bin`; Ubuntu has further ones beside it.
fn distribution() -> Vec<PathBuf> {
    let mut found = vec![PathBuf::from("/usr/bin/rustc")];
    if let Ok(entries) = std::fs::read_dir("/usr/lib") {
        let rust = entries.flatten().filter(|entry| entry.file_name().to_string_lossy().starts_with("rust-"));
        found.extend(rust.map(|entry| entry.path().join("bin/rustc")));
    }
    found.retain(|rustc| rustc.is_file());
    found
}

/// The file that a program's name or path leads to, so that no compiler is looked at twice.
fn resolve(program: &Path) -> PathBuf {
    let in_path = || {
        let path = std::env::var_os("PATH")?;
        std::env::split_paths(&path).map(|dir| dir.join(program)).find(|file| file.is_file())
    };
    let file = if program.components().count() == 1 { in_path() } else { None };
    let file = file.unwrap_or_else(|| program.to_path_buf());
    std::fs::canonicalize(&file).unwrap_or(file)
}

fn output(program: &Path, args: &[&str]) -> Result<String, String> {
    let output = Command::new(program).args(args).env_remove(LIBRARY_PATH).output().map_err(|e| e.to_string())?;
    if output.status.success() {
        String::from_utf8(output.stdout).map_err(|e| e.to_string())
    } else {
        let text = String::from_utf8_lossy(&output.stderr);
        Err(text.lines().next().unwrap_or("it fails").to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn releases_compare_as_numbers() {
        let release = |text| Release::parse(text).expect(text);
        assert!(release("1.100.0") > release("1.96.0"));
        assert!(release("1.97.0-nightly") > MINIMUM);
        assert_eq!(Release::parse("stable-x86_64"), None);
    }

    #[test]
    fn architectures_are_in_order() {
        let list = "Available CPUs for this target:\n    sm_100\n    sm_100a\n    sm_35\n    sm_75 - the default\n    sm_90a\n";
        assert_eq!(architectures(list), ["sm_75", "sm_100"]);
    }

    #[test]
    fn a_missing_compiler_is_a_reason_not_a_panic() {
        let rejected = DeviceCompiler::check(Path::new("/nonexistent/rustc")).expect_err("there is none");
        assert!(matches!(rejected.why, Why::DoesNotRun(_)));
    }
}
