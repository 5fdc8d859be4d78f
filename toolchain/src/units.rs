//! What cargo would compile, and how: its unit graph.
//!
//! `cargo metadata` does not tell which features a package has in a particular build, where another member of the
//! workspace may have switched on more, nor what the profile sets for each package. The unit graph does.

use std::process::Command;

use crate::cargo;
use crate::error::Error;
use crate::json::Json;

/// A crate that would be compiled, or a build script that would run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Unit {
    /// The package's id.
    pub package: String,
    /// `lib`, `proc-macro`, `custom-build`.
    kind: String,
    /// `build`, `run-custom-build`.
    mode: String,
    /// The target. `None` for crates that run on the host while compiling, such as proc macros.
    platform: Option<String>,
    /// The features that are on.
    pub features: Vec<String>,
    /// The settings of the profile that change what the code does.
    pub checks: Checks,
}

/// The run-time checks that a profile switches on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Checks {
    /// `overflow-checks`
    pub overflow: bool,
    /// `debug-assertions`
    pub assertions: bool,
}

impl Checks {
    /// Both on, or both off.
    pub fn all(on: bool) -> Self {
        Self { overflow: on, assertions: on }
    }
}

impl Unit {
    fn from_json(json: &Json) -> Option<Self> {
        let text = |json: &Json| json.str().map(str::to_string);
        let is_on = |setting: &str| json.get("profile").get(setting) == &Json::Bool(true);
        Some(Self {
            package: text(json.get("pkg_id"))?,
            kind: text(json.get("target").get("kind").items().first()?)?,
            mode: text(json.get("mode"))?,
            platform: text(json.get("platform")),
            features: json.get("features").items().iter().filter_map(text).collect(),
            checks: Checks { overflow: is_on("overflow_checks"), assertions: is_on("debug_assertions") },
        })
    }

    /// A unit for tests.
    #[cfg(test)]
    pub fn of(package: &str, kind: &str, features: &[&str]) -> Self {
        let features = features.iter().map(ToString::to_string).collect();
        let (package, kind, mode) = (package.into(), kind.into(), "build".into());
        Self { package, kind, mode, platform: None, features, checks: Checks::all(false) }
    }

    /// Whether both are the same part of their packages.
    pub fn is_same_part(&self, other: &Self) -> bool {
        (&self.kind, &self.mode, &self.platform) == (&other.kind, &other.mode, &other.platform)
    }

    /// Whether it is a library that becomes a part of a program for this target, or, for `None`, of one for the machine
    /// that compiles.
    pub fn is_library(&self, target: Option<&str>) -> bool {
        let is_library = self.mode == "build" && !matches!(self.kind.as_str(), "proc-macro" | "custom-build" | "bin");
        is_library && self.platform.as_deref() == target
    }
}

/// The units that a `cargo build` would compile.
pub(crate) fn units(command: &mut Command, doing: &str) -> Result<Vec<Unit>, Error> {
    // Without this variable, only nightly compilers accept the option.
    let is_quiet = command.get_args().any(|arg| arg == "--quiet");
    command.args((!is_quiet).then_some("--quiet"));
    command.args(["--unit-graph", "-Zunstable-options"]).env("RUSTC_BOOTSTRAP", "1");
    let text = cargo::read(command, doing)?;
    let bad = |reason: String| Error::Output { of: "cargo build --unit-graph".into(), reason };
    let json = Json::parse(&text).map_err(bad)?;
    let units: Option<Vec<Unit>> = json.get("units").items().iter().map(Unit::from_json).collect();
    units.filter(|units| !units.is_empty()).ok_or_else(|| bad("this version of cargo writes it in another form".into()))
}
