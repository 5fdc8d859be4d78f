//! What `cargo metadata` says of packages.

use std::path::{Path, PathBuf};

use crate::cargo;
use crate::error::Error;
use crate::json::Json;
use crate::util;

/// A package of a workspace or of a dependency graph.
#[derive(Clone, Debug)]
pub struct Package {
    /// What cargo calls it in its messages.
    pub(crate) id: String,
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
    /// Whether it is a proc macro.
    pub(crate) is_macro: bool,
    /// Those of its features that are on, in a dependency graph.
    pub(crate) enabled: Vec<String>,
    /// The ids of the packages that its code uses, in a dependency graph.
    pub(crate) uses: Vec<String>,
}

impl Package {
    fn from_json(json: &Json) -> Option<Self> {
        const LIBRARIES: [&str; 5] = ["lib", "rlib", "dylib", "staticlib", "cdylib"];
        let is = |target: &Json, kinds: &[&str]| {
            target.get("kind").items().iter().any(|kind| kind.str().is_some_and(|kind| kinds.contains(&kind)))
        };
        let targets = json.get("targets").items();
        let library = targets.iter().find(|target| is(target, &LIBRARIES));
        Some(Self {
            id: json.get("id").str()?.to_string(),
            name: json.get("name").str()?.to_string(),
            version: json.get("version").str()?.to_string(),
            manifest: json.get("manifest_path").str()?.into(),
            source: json.get("source").str().map(str::to_string),
            library: library.and_then(|target| target.get("name").str()).map(|name| name.replace('-', "_")),
            has_shaders: json.get("metadata").get("optix").get("shaders") == &Json::Bool(true),
            features: json.get("features").members().map(|(name, _)| name.to_string()).collect(),
            is_macro: targets.iter().any(|target| is(target, &["proc-macro"])),
            enabled: Vec::new(),
            uses: Vec::new(),
        })
    }

    /// Adds what a node of the dependency graph says.
    fn with_node(mut self, nodes: &[Json]) -> Self {
        if let Some(node) = nodes.iter().find(|node| node.get("id").str() == Some(&self.id)) {
            let is_normal =
                |dep: &&Json| dep.get("dep_kinds").items().iter().any(|kind| kind.get("kind") == &Json::Null);
            let uses = node.get("deps").items().iter().filter(is_normal).filter_map(|dep| dep.get("pkg").str());
            self.uses = uses.map(str::to_string).collect();
            self.enabled = node.get("features").items().iter().filter_map(Json::str).map(str::to_string).collect();
        }
        self
    }

    /// The folder of the package.
    pub fn dir(&self) -> &Path {
        self.manifest.parent().unwrap_or(&self.manifest)
    }

    /// Whether its sources name the crate `alloc`.
    pub(crate) fn may_use_alloc(&self) -> bool {
        util::any_source(&self.dir().join("src"), &|text| text.contains("extern crate alloc"))
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
        let nodes = json.get("resolve").get("nodes").items();
        let packages = json.get("packages").items().iter().filter_map(Package::from_json);
        Ok(Self {
            root: path("workspace_root")?,
            target_dir: path("target_directory")?,
            packages: packages.map(|package| package.with_node(nodes)).collect(),
        })
    }

    /// The packages whose code is a part of the package `from`, each at the end of the shortest way to it.
    pub(crate) fn ways(&self, from: &Package) -> Vec<Vec<&Package>> {
        let mut ways: Vec<Vec<&Package>> = self.packages.iter().filter(|p| p.id == from.id).map(|p| vec![p]).collect();
        let mut at = 0;
        while let Some(way) = ways.get(at).cloned() {
            let uses = way.last().map_or(&[][..], |last| &last.uses);
            for package in self.packages.iter().filter(|package| uses.contains(&package.id) && !package.is_macro) {
                if !ways.iter().flatten().any(|seen| seen.id == package.id) {
                    ways.push(way.iter().copied().chain([package]).collect());
                }
            }
            at += 1;
        }
        ways
    }
}
