//! What `cargo metadata` says of packages.

use std::path::{Path, PathBuf};

use crate::cargo;
use crate::error::Error;
use crate::json::Json;

/// A package of a workspace or of a dependency graph.
#[derive(Clone, Debug)]
pub struct Package {
    /// Its name in the manifest: `my-shaders`.
    pub name: String,
    /// Its version.
    pub version: String,
    /// Its `Cargo.toml`.
    pub manifest: PathBuf,
    /// Where it comes from: `None` for a path, otherwise `registry+https://..` and the like.
    pub source: Option<String>,
    /// The name of its library target, as in `use my_shaders::..`. `None`: it has none.
    pub library: Option<String>,
    /// Whether its manifest has `[package.metadata.optix] shaders = true`.
    pub has_shaders: bool,
    /// Its features.
    pub features: Vec<String>,
}

impl Package {
    fn from_json(json: &Json) -> Option<Self> {
        const LIBRARIES: [&str; 5] = ["lib", "rlib", "dylib", "staticlib", "cdylib"];
        let is_library = |target: &&Json| {
            target.get("kind").items().iter().any(|kind| kind.str().is_some_and(|kind| LIBRARIES.contains(&kind)))
        };
        let library = json.get("targets").items().iter().find(is_library);
        Some(Self {
            name: json.get("name").str()?.to_string(),
            version: json.get("version").str()?.to_string(),
            manifest: json.get("manifest_path").str()?.into(),
            source: json.get("source").str().map(str::to_string),
            library: library.and_then(|target| target.get("name").str()).map(|name| name.replace('-', "_")),
            has_shaders: json.get("metadata").get("optix").get("shaders") == &Json::Bool(true),
            features: json.get("features").members().map(|(name, _)| name.to_string()).collect(),
        })
    }

    /// The folder of the package.
    pub fn dir(&self) -> &Path {
        self.manifest.parent().unwrap_or(&self.manifest)
    }
}

/// A workspace and its members.
#[derive(Clone, Debug)]
pub struct Workspace {
    /// The folder of its root manifest.
    pub root: PathBuf,
    /// Where its builds go.
    pub target_dir: PathBuf,
    /// Its members.
    pub packages: Vec<Package>,
}

impl Workspace {
    /// The workspace of the package in `dir`; reads manifests only, and touches no lock file.
    pub fn of(dir: &Path) -> Result<Self, Error> {
        Self::read(dir, &["--no-deps"])
    }

    /// As [`Workspace::of`], but `packages` is every package of the dependency graph for the device. Writes the lock file.
    pub(crate) fn with_dependencies(dir: &Path) -> Result<Self, Error> {
        Self::read(dir, &["--filter-platform", crate::compiler::TARGET])
    }

    fn read(dir: &Path, args: &[&str]) -> Result<Self, Error> {
        let mut command = cargo::command(dir);
        command.args(["metadata", "--quiet", "--format-version", "1"]).args(args);
        // The caller wants to know where its own builds go.
        for name in ["CARGO_TARGET_DIR", "CARGO_BUILD_TARGET_DIR"] {
            let dir = std::env::var_os(name).and_then(|dir| std::path::absolute(dir).ok());
            command.envs(dir.map(|dir| (name, dir)));
        }
        let text = cargo::read(&mut command, &format!("reading the manifests in {}", dir.display()))?;
        let bad = |reason: String| Error::Output { of: "cargo metadata".into(), reason };
        let json = Json::parse(&text).map_err(bad)?;
        let path = |name: &str| json.get(name).str().map(PathBuf::from).ok_or_else(|| bad(format!("no `{name}`")));
        Ok(Self {
            root: path("workspace_root")?,
            target_dir: path("target_directory")?,
            packages: json.get("packages").items().iter().filter_map(Package::from_json).collect(),
        })
    }
}
