//! What `cargo metadata` says of packages.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::cargo::{self, Place};
use crate::error::Error;
use crate::json::Json;
use crate::util;

/// A package of a workspace or of a dependency graph.
#[derive(Clone, Debug)]
pub struct Package {
    /// Its package id: what cargo calls it in its messages.
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
    /// Which of its other features each feature switches on.
    pub(crate) implied: Vec<(String, Vec<String>)>,
    /// Whether it is a proc macro.
    pub(crate) is_macro: bool,
    /// Its features that are on. Known in a dependency graph only, as are the next two fields.
    pub(crate) enabled: Vec<String>,
    /// The packages that its code uses.
    pub(crate) uses: Vec<String>,
    /// The packages that it depends on, including those of its build script, but not of its tests.
    pub(crate) links: Vec<Link>,
    /// The packages that its manifest names, each with the source that it names. `None` for a path.
    pub(crate) asks: Vec<(String, Option<String>)>,
}

/// A package that another depends on.
#[derive(Clone, Debug)]
pub(crate) struct Link {
    /// What the other calls it in its code.
    pub name: String,
    /// The package's id.
    pub id: String,
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
            implied: json
                .get("features")
                .members()
                .map(|(name, list)| {
                    (name.to_string(), list.items().iter().filter_map(Json::str).map(str::to_string).collect())
                })
                .collect(),
            is_macro: targets.iter().any(|target| is(target, &["proc-macro"])),
            enabled: Vec::new(),
            uses: Vec::new(),
            links: Vec::new(),
            asks: json.get("dependencies").items().iter().filter_map(asked).collect(),
        })
    }

    /// Adds what a node of the dependency graph says.
    fn with_node(mut self, nodes: &[Json]) -> Self {
        if let Some(node) = nodes.iter().find(|node| node.get("id").str() == Some(&self.id)) {
            let is_of = |dep: &Json, wanted: &[Option<&str>]| {
                dep.get("dep_kinds").items().iter().any(|kind| wanted.contains(&kind.get("kind").str()))
            };
            for dep in node.get("deps").items() {
                let (Some(name), Some(id)) = (dep.get("name").str(), dep.get("pkg").str()) else { continue };
                if is_of(dep, &[None]) {
                    self.uses.push(id.to_string());
                }
                if is_of(dep, &[None, Some("build")]) {
                    self.links.push(Link { name: name.to_string(), id: id.to_string() });
                }
            }
            self.enabled = node.get("features").items().iter().filter_map(Json::str).map(str::to_string).collect();
        }
        self
    }

    /// The folder of the package.
    pub fn dir(&self) -> &Path {
        self.manifest.parent().unwrap_or(&self.manifest)
    }

    /// These features with the ones that they switch on, in order.
    pub(crate) fn with_implied(&self, features: Vec<String>) -> Vec<String> {
        let mut on = features;
        let mut at = 0;
        while let Some(feature) = on.get(at) {
            let implied = self.implied.iter().filter(|(name, _)| name == feature).flat_map(|(_, implied)| implied);
            let new: Vec<String> = implied.filter(|f| self.features.contains(f) && !on.contains(f)).cloned().collect();
            on.extend(new);
            at += 1;
        }
        on.sort_unstable();
        on.dedup();
        on
    }

    /// Its version and where it comes from, for messages.
    pub(crate) fn origin(&self) -> String {
        match self.source.as_deref() {
            None => format!("{} in {}", self.version, self.dir().display()),
            Some(CRATES_IO) => format!("{} of crates.io", self.version),
            Some(source) => format!("{} of {source}", self.version),
        }
    }

    /// Whether both are the same sources.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        let real = |package: &Self| std::fs::canonicalize(&package.manifest).ok();
        let both_here = self.source.is_none() && other.source.is_none();
        self.name == other.name
            && self.version == other.version
            && self.source == other.source
            && (!both_here || real(self) == real(other))
    }

    /// Whether its sources name the crate `alloc`.
    pub(crate) fn may_use_alloc(&self) -> bool {
        util::any_source(&self.dir().join("src"), &|text| text.contains("extern crate alloc"))
    }
}

/// The source of packages of crates.io.
pub(crate) const CRATES_IO: &str = "registry+https://github.com/rust-lang/crates.io-index";

/// A dependency in a manifest: the package's name and its source.
fn asked(dependency: &Json) -> Option<(String, Option<String>)> {
    Some((dependency.get("name").str()?.to_string(), dependency.get("source").str().map(str::to_string)))
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
    /// The ids of its members.
    pub(crate) members: Vec<String>,
}

impl Workspace {
    /// The workspace of the package in `dir`; reads manifests only, and touches no lock file.
    pub fn of(dir: &Path) -> Result<Self, Error> {
        Self::with_options(dir, &[])
    }

    /// As [`Workspace::of`], by a cargo that is given these options in the current folder.
    pub fn with_options(dir: &Path, options: &[OsString]) -> Result<Self, Error> {
        let options =
            std::env::current_dir().map_or_else(|_| options.to_vec(), |here| cargo::elsewhere(options, &here));
        Self::at(&Place { dir: dir.to_path_buf(), options })
    }

    /// The workspace of the package in the folder where cargo runs.
    pub(crate) fn at(place: &Place) -> Result<Self, Error> {
        let mut command = cargo::command(&place.dir);
        command.args(["metadata", "--no-deps"]).args(&place.options);
        Self::read(command, &format!("reading the manifests in {}", place.dir.display()))
    }

    /// As [`Workspace::of`], but `packages` is every package of the dependency graph, for the device and further targets.
    /// Writes the lock file.
    pub(crate) fn with_dependencies(place: &Place, manifest: &Path, args: &[&str]) -> Result<Self, Error> {
        let mut command = place.cargo("metadata", manifest);
        command.args(["--filter-platform", crate::compiler::TARGET]).args(args);
        Self::read(command, &format!("reading the dependencies of {}", manifest.display()))
    }

    /// The package with this id.
    pub(crate) fn package(&self, id: &str) -> Option<&Package> {
        self.packages.iter().find(|package| package.id == id)
    }

    fn read(mut command: Command, doing: &str) -> Result<Self, Error> {
        command.args(["--quiet", "--format-version", "1"]);
        // The variable would otherwise change the answer to where the user's own builds go.
        for name in ["CARGO_TARGET_DIR", "CARGO_BUILD_TARGET_DIR"] {
            let dir = std::env::var_os(name).and_then(|dir| std::path::absolute(dir).ok());
            command.envs(dir.map(|dir| (name, dir)));
        }
        Self::parse(&cargo::read(&mut command, doing)?)
    }

    /// Reads what `cargo metadata` prints.
    pub(crate) fn parse(text: &str) -> Result<Self, Error> {
        let bad = |reason: String| Error::Output { of: "cargo metadata".into(), reason };
        let json = Json::parse(text).map_err(bad)?;
        let path = |name: &str| json.get(name).str().map(PathBuf::from).ok_or_else(|| bad(format!("no `{name}`")));
        let nodes = json.get("resolve").get("nodes").items();
        let packages = json.get("packages").items().iter().filter_map(Package::from_json);
        Ok(Self {
            root: path("workspace_root")?,
            target_dir: path("target_directory")?,
            packages: packages.map(|package| package.with_node(nodes)).collect(),
            members: json.get("workspace_members").items().iter().filter_map(Json::str).map(str::to_string).collect(),
        })
    }

    /// For each package whose code becomes a part of the package `from`, the shortest way to it over dependencies.
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
