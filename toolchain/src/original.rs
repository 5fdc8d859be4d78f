//! What the user's own build makes a shader crate from, and whether a device build is made from the same.
//!
//! A device build goes through a generated package, which cargo takes for a workspace of its own. So what stands in the root of
//! the user's workspace does not count there: `[patch]`, `[replace]`, the lock file, the resolver, profiles. The
//! generated package is given all of these, as they came out in the user's workspace; then both dependency graphs are
//! compared, and a difference is an error, because otherwise host and device would run different code.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::cargo::{self, Place};
use crate::compiler::DeviceCompiler;
use crate::error::{Difference, Error, Lacking};
use crate::metadata::{CRATES_IO, Package, Workspace};
use crate::options::Shaders;
use crate::outer::Outer;
use crate::units::{self, Checks, Unit};
use crate::util::toml_string;

/// The user's workspace and the shader crate in it.
pub(crate) struct Original {
    /// Where cargo runs.
    pub place: Place,
    /// The workspace with all dependencies.
    pub workspace: Workspace,
    /// The shader crate.
    pub shaders: Package,
    /// Whether the shader crate is a member of the workspace. If so, its features can be chosen.
    pub is_member: bool,
    /// Whether cargo must leave the lock file as it is: because a build that uses it is under way, or because the user
    /// said `--locked`.
    pub is_locked: bool,
}

impl Original {
    /// The workspace of the package that is being built, if the shader crate is a part of it; otherwise the shader
    /// crate's own.
    pub fn find(shaders: &Shaders) -> Result<Self, Error> {
        let path = &shaders.path;
        let not = |lacks| Error::NotAShaderCrate { path: path.to_path_buf(), lacks };
        let dir = std::fs::canonicalize(path).map_err(|_| not(Lacking::Folder))?;
        if !dir.join("Cargo.toml").is_file() {
            return Err(not(Lacking::Manifest));
        }
        if let Some(outer) = &shaders.outer
            && let Some(found) = Self::of_outer(outer, shaders, &dir)?
        {
            return Ok(found);
        }
        let here = std::env::current_dir().ok();
        let options = match (&shaders.outer, &here) {
            (Some(outer), _) => outer.options.clone(),
            (None, Some(here)) => cargo::elsewhere(&shaders.cargo_options, here),
            (None, None) => shaders.cargo_options.clone(),
        };
        let root = Workspace::at(&Place { dir: dir.clone(), options: options.clone() })?.root;
        let here = here.filter(|here| shaders.outer.is_none() && here.starts_with(&root));
        let place = Place { dir: here.unwrap_or_else(|| root.clone()), options };
        let of_begun_build = || shaders.outer.is_some() && root.join("Cargo.lock").is_file();
        let is_locked = shaders.locked || of_begun_build();
        let mut args = shaders.feature_options();
        args.extend(is_locked.then(|| "--locked".to_string()));
        let args: Vec<&str> = args.iter().map(String::as_str).collect();
        let workspace = Workspace::with_dependencies(&place, &dir.join("Cargo.toml"), &args)?;
        Self::new(place, workspace, &dir, is_locked).ok_or_else(|| not(Lacking::Package))
    }

    /// In the workspace of the package that is being built. `None` if the shader crate is not a part of it.
    fn of_outer(outer: &Outer, shaders: &Shaders, dir: &Path) -> Result<Option<Self>, Error> {
        let folder = outer.manifest.parent().unwrap_or(&outer.manifest);
        let manifests = Workspace::at(&Place { dir: folder.to_path_buf(), options: outer.options.clone() })?;
        let place =
            Place { dir: outer.dir.clone().unwrap_or_else(|| manifests.root.clone()), options: outer.options.clone() };
        let is_locked = manifests.root.join("Cargo.lock").is_file();
        let mut args = outer.feature_options(shaders, dir, &manifests);
        args.extend(is_locked.then(|| "--locked".to_string()));
        // The dependencies for the host's target as well: the program may use the shader crate on some targets only.
        let host = std::env::var("TARGET").unwrap_or_default();
        args.extend((!host.is_empty()).then(|| format!("--filter-platform={host}")));
        let args: Vec<&str> = args.iter().map(String::as_str).collect();
        let workspace = Workspace::with_dependencies(&place, &outer.manifest, &args)?;
        Ok(Self::new(place, workspace, dir, is_locked))
    }

    fn new(place: Place, workspace: Workspace, dir: &Path, is_locked: bool) -> Option<Self> {
        // Cargo may know the folder by another path, through a symbolic link.
        let is_it = |package: &&Package| std::fs::canonicalize(package.dir()).is_ok_and(|real| real == dir);
        let shaders = workspace.packages.iter().filter(|package| package.source.is_none()).find(is_it)?.clone();
        let is_member = workspace.members.contains(&shaders.id);
        Some(Self { place, workspace, shaders, is_member, is_locked })
    }

    /// The units that cargo would compile for the program that is built; none if the shader crate is not among them.
    pub fn units_of_host(&self, outer: &Outer, compiler: &DeviceCompiler, area: &Path) -> Result<Vec<Unit>, Error> {
        let is_it = |package: &&Package| package.manifest == outer.manifest;
        let Some(host) = self.workspace.packages.iter().find(is_it) else { return Ok(Vec::new()) };
        let features: Vec<&str> = outer.features(host).collect();
        let mut command = self.build(host, &outer.profile, &features, &area.join("host"));
        // Configuration files for a nightly cargo may ask for `build-std`, which needs the library sources that this
        // compiler has.
        compiler.used_by(&mut command);
        command.args(outer.target.iter().flat_map(|target| ["--target", target]));
        let mut units = units::units(&mut command, &format!("finding out how {} is compiled", outer.name))?;
        if !units.iter().any(|unit| unit.package == self.shaders.id) {
            units.clear();
        }
        Ok(units)
    }

    /// A `cargo build` of a package in the user's workspace.
    pub fn build(&self, package: &Package, profile: &str, features: &[&str], target_dir: &Path) -> Command {
        let mut command = self.place.cargo("build", &package.manifest);
        command.args(["--package", &package.id, "--profile", profile, "--no-default-features"]);
        command.arg(format!("--features={}", features.join(","))).arg("--target-dir").arg(target_dir);
        command.args(self.is_locked.then_some("--locked"));
        command
    }

    /// The lock file, which need not be there.
    pub fn lock(&self) -> PathBuf {
        self.workspace.root.join("Cargo.lock")
    }

    /// The manifests and configuration files that the build depends on.
    pub fn settings(&self) -> Vec<PathBuf> {
        // Any member of the workspace may switch on features.
        let members = self.workspace.members.iter().filter_map(|id| self.workspace.package(id));
        let mut files: Vec<PathBuf> = members.map(|package| package.manifest.clone()).collect();
        files.extend([self.workspace.root.join("Cargo.toml"), self.lock()]);
        let home = std::env::var_os("CARGO_HOME").map(PathBuf::from);
        let folders = self.place.dir.ancestors().map(|dir| dir.join(".cargo")).chain(home);
        files.extend(folders.flat_map(|folder| ["config.toml", "config"].map(|name| folder.join(name))));
        files.retain(|file| file.is_file());
        files
    }

    /// The entries of `[patch]` with which another workspace resolves to the same packages. There is one for every
    /// package that does not come from where the manifest that depends on it says.
    pub fn patches(&self) -> Vec<Patch> {
        let mut patches: Vec<Patch> = Vec::new();
        let mut seen = vec![self.shaders.id.clone()];
        let mut at = 0;
        while let Some(package) = seen.get(at).and_then(|id| self.workspace.package(id)) {
            for link in &package.links {
                let Some(used) = self.workspace.package(&link.id) else { continue };
                let mut asked = package.asks.iter().filter(|(name, _)| *name == used.name).map(|(_, source)| source);
                let come_from = used.source.as_deref().map(without_revision);
                let sources: Vec<&str> = asked.clone().flatten().map(String::as_str).collect();
                if !asked.any(|source| source.as_deref().map(without_revision) == come_from) {
                    for of in sources.into_iter().map(patched) {
                        if !patches.iter().any(|patch| patch.of == of && patch.package.id == used.id) {
                            patches.push(Patch { of, package: used.clone() });
                        }
                    }
                }
                if !seen.contains(&link.id) {
                    seen.push(link.id.clone());
                }
            }
            at += 1;
        }
        patches.sort_by(|a, b| (&a.of, &a.package.id).cmp(&(&b.of, &b.package.id)));
        patches
    }

    /// The features that the device build has to switch on: those with which the host uses the crate, or the chosen
    /// ones if the host does not use it.
    pub fn features(&self, shaders: &Shaders, of_host: &[Unit]) -> Result<Vec<String>, Error> {
        let is_it = |unit: &&Unit| unit.package == self.shaders.id && unit.is_library(None);
        let chosen = || {
            let default =
                shaders.default_features != Some(false) && self.shaders.features.iter().any(|f| f == "default");
            let chosen = shaders.features.iter().flatten().cloned();
            chosen.chain(default.then(|| "default".to_string())).collect::<Vec<_>>()
        };
        let target = shaders.outer.as_ref().and_then(|outer| outer.target.as_deref());
        let of_target = |unit: &&Unit| unit.package == self.shaders.id && unit.is_library(target);
        let Some(unit) = of_host.iter().find(of_target).or_else(|| of_host.iter().find(is_it)) else {
            return Ok(chosen());
        };
        if shaders.features.is_some() || shaders.default_features.is_some() {
            let chosen = self.shaders.with_implied(chosen());
            let mut differences = Vec::new();
            let mut only = |these: &[String], those: &[String], on_device| {
                let missing = these.iter().filter(|feature| !those.contains(feature));
                differences.extend(missing.map(|feature| Difference::Feature { feature: feature.clone(), on_device }));
            };
            only(&unit.features, &chosen, false);
            only(&chosen, &unit.features, true);
            if !differences.is_empty() {
                return Err(Error::Differs { package: self.shaders.name.clone(), differences });
            }
        }
        Ok(unit.features.clone())
    }

    /// The run-time checks of the shader crate, and those of the packages of the device build that have others.
    pub fn checks(&self, units: &[Unit], target: Option<&str>, device: &Workspace) -> (Checks, Vec<(String, Checks)>) {
        let of = |package: &Package| {
            let unit = units.iter().find(|unit| unit.package == package.id && unit.is_library(target));
            unit.map(|unit| unit.checks)
        };
        let own = of(&self.shaders).unwrap_or(Checks::all(false));
        let packages =
            self.workspace.packages.iter().filter(|package| device.packages.iter().any(|p| p.is_same(package)));
        let others = packages.filter_map(|package| {
            let checks = of(package).filter(|checks| *checks != own)?;
            Some((format!("{}@{}", package.name, package.version), checks))
        });
        (own, others.collect())
    }

    /// How the dependency graph of a device build differs. Empty if it has the same packages.
    pub fn differences(&self, device: &Workspace) -> Vec<Difference> {
        let Some(shaders) = device.packages.iter().find(|package| package.is_same(&self.shaders)) else {
            return vec![Difference::NotOnDevice { package: self.shaders.name.clone() }];
        };
        let mut differences = Vec::new();
        let mut pairs = vec![(&self.shaders, shaders)];
        let mut at = 0;
        while let Some((theirs, ours)) = pairs.get(at).copied() {
            for link in &ours.links {
                let Some(our) = device.package(&link.id) else { continue };
                let linked = theirs.links.iter().filter(|their| their.name == link.name);
                let linked: Vec<&Package> = linked.filter_map(|link| self.workspace.package(&link.id)).collect();
                match linked.iter().find(|their| their.is_same(our)) {
                    Some(their) if pairs.iter().any(|(_, seen)| seen.id == our.id) => _ = their,
                    Some(their) => pairs.push((their, our)),
                    None => {
                        let host = linked.first().map(|their| their.origin());
                        let difference = Difference::Package { package: our.name.clone(), host, device: our.origin() };
                        if !differences.contains(&difference) {
                            differences.push(difference);
                        }
                    }
                }
            }
            at += 1;
        }
        differences
    }

    /// How features differ between what cargo would compile of the shader crate in the user's workspace, and in the
    /// device build's.
    pub fn feature_differences(&self, theirs: &[Unit], device: &Workspace, ours: &[Unit]) -> Vec<Difference> {
        let mut differences = Vec::new();
        for our in ours {
            let Some(package) = device.package(&our.package).filter(|p| !device.members.contains(&p.id)) else {
                continue;
            };
            let is_it = |their: &&Unit| {
                let their_package = self.workspace.package(&their.package);
                their.is_same_part(our) && their_package.is_some_and(|their| their.is_same(package))
            };
            let parts: Vec<&Unit> = theirs.iter().filter(is_it).collect();
            if parts.iter().any(|their| their.features == our.features) {
                continue;
            }
            let difference = Difference::Features {
                package: package.name.clone(),
                host: parts.first().map(|their| their.features.clone()),
                device: our.features.clone(),
            };
            if !differences.contains(&difference) {
                differences.push(difference);
            }
        }
        differences
    }
}

/// An entry of `[patch]`.
pub(crate) struct Patch {
    /// The source that is patched: `crates-io`, or the address of a registry or repository.
    of: String,
    /// The package that is taken instead.
    package: Package,
}

/// The `[patch]` tables for a manifest, including the one for `libm`.
pub(crate) fn patch_tables(patches: &[Patch], libm: Option<&Path>) -> String {
    let mut text = String::new();
    let mut sources: Vec<&str> = patches.iter().map(|patch| patch.of.as_str()).collect();
    sources.extend(libm.map(|_| CRATES_IO_NAME));
    sources.sort_unstable();
    sources.dedup();
    for source in sources {
        _ = write!(text, "\n[patch.{}]\n", toml_string(source));
        let mut names: Vec<&str> = Vec::new();
        for Patch { package, .. } in patches.iter().filter(|patch| patch.of == source) {
            // The entry has the package's own name, so that an entry in a configuration file replaces it and does not
            // become a second one.
            let count = names.iter().filter(|name| **name == package.name).count();
            names.push(&package.name);
            let key = if count == 0 { package.name.clone() } else { format!("{}-{count}", package.name) };
            _ = writeln!(
                text,
                "{} = {{ package = {}, {} }}",
                toml_string(&key),
                toml_string(&package.name),
                taken_from(package)
            );
        }
        if let Some(libm) = libm.filter(|_| source == CRATES_IO_NAME) {
            _ = writeln!(text, "libm = {{ path = {} }}", toml_string(&libm.to_string_lossy()));
        }
    }
    text
}

const CRATES_IO_NAME: &str = "crates-io";

/// The fields of a manifest's dependency that ask for exactly this package.
pub(crate) fn taken_from(package: &Package) -> String {
    let version = format!("version = \"={}\"", package.version.split('+').next().unwrap_or_default());
    let Some(source) = package.source.as_deref() else {
        return format!("path = {}", toml_string(&package.dir().to_string_lossy()));
    };
    if source == CRATES_IO {
        version
    } else if let Some(git) = source.strip_prefix("git+") {
        let (address, reference) = without_revision(git).split_once('?').unwrap_or((without_revision(git), ""));
        let reference = reference.split_once('=').filter(|(kind, _)| ["branch", "tag", "rev"].contains(kind));
        let reference = reference.map(|(kind, name)| format!(", {kind} = {}", toml_string(&decoded(name))));
        format!("git = {}{}", toml_string(address), reference.unwrap_or_default())
    } else {
        let index = source.strip_prefix("registry+").unwrap_or(source);
        format!("{version}, registry-index = {}", toml_string(index))
    }
}

/// Decodes the text of a URL's query, in which cargo writes everything but letters and digits like `%2F`.
fn decoded(text: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        let code = after.get(..2).filter(|_| *first == b'%').and_then(|digits| std::str::from_utf8(digits).ok());
        match code.and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                rest = &after[2..];
            }
            None => {
                bytes.push(if *first == b'+' { b' ' } else { *first });
                rest = after;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// A source without the commit, which lock files add.
fn without_revision(source: &str) -> &str {
    source.split('#').next().unwrap_or(source)
}

/// The name that `[patch]` has for a source.
fn patched(source: &str) -> String {
    if source == CRATES_IO {
        return CRATES_IO_NAME.to_string();
    }
    let address = source.strip_prefix("registry+").or_else(|| source.strip_prefix("git+")).unwrap_or(source);
    without_revision(address).split('?').next().unwrap_or(address).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A workspace in which the shader crate uses `number` of this version and source.
    fn workspace(version: &str, source: Option<&str>) -> Workspace {
        let source = source.map_or("null".to_string(), |source| format!("{source:?}"));
        let package = |name: &str, version: &str, source: &str, asks: &str| {
            format!(
                r#"{{"id":"{name}","name":"{name}","version":"{version}","manifest_path":"/nowhere/{name}/Cargo.toml",
                "source":{source},"targets":[],"features":{{}},"dependencies":[{asks}]}}"#
            )
        };
        let asks = format!(r#"{{"name":"number","source":{CRATES_IO:?}}}"#);
        let packages = [package("shaders", "1.0.0", "null", &asks), package("number", version, &source, "")].join(",");
        let nodes = r#"{"id":"shaders","deps":[{"name":"number","pkg":"number","dep_kinds":[{"kind":null}]}]}"#;
        let text = format!(
            r#"{{"workspace_root":"/nowhere","target_directory":"/nowhere","workspace_members":["shaders"],
            "packages":[{packages}],"resolve":{{"nodes":[{nodes}]}}}}"#
        );
        Workspace::parse(&text).expect("it is as cargo prints it")
    }

    fn original(version: &str, source: Option<&str>) -> Original {
        let workspace = workspace(version, source);
        let shaders = workspace.packages[0].clone();
        let place = Place { dir: "/nowhere".into(), options: Vec::new() };
        Original { place, workspace, shaders, is_member: true, is_locked: true }
    }

    fn words(differences: &[Difference]) -> String {
        differences.iter().map(Difference::to_string).collect::<Vec<_>>().join("; ")
    }

    #[test]
    fn other_packages_are_found() {
        let theirs = original("1.0.0", Some(CRATES_IO));
        assert_eq!(theirs.differences(&workspace("1.0.0", Some(CRATES_IO))), []);
        let found = |version, source| words(&theirs.differences(&workspace(version, source)));
        assert_eq!(
            found("1.0.1", Some(CRATES_IO)),
            "`number` is 1.0.0 of crates.io there and 1.0.1 of crates.io on the device"
        );
        assert_eq!(
            found("1.0.0", None),
            "`number` is 1.0.0 of crates.io there and 1.0.0 in /nowhere/number on the device"
        );
        assert!(
            found("1.0.0", Some("git+https://x.y/z#0123")).ends_with("1.0.0 of git+https://x.y/z#0123 on the device")
        );
        let mut without = workspace("1.0.0", Some(CRATES_IO));
        without.packages.remove(0);
        assert_eq!(words(&theirs.differences(&without)), "`shaders` is not in the device build");
    }

    #[test]
    fn other_features_are_found() {
        let unit = |features: &[&str]| Unit::of("number", "lib", features);
        let theirs = original("1.0.0", Some(CRATES_IO));
        let device = workspace("1.0.0", Some(CRATES_IO));
        let found = |ours: Unit| words(&theirs.feature_differences(&[unit(&["fast"])], &device, &[ours]));
        assert_eq!(found(unit(&["fast"])), "");
        assert_eq!(found(unit(&[])), "the features of `number` are [fast] there and [] on the device");
        assert_eq!(
            found(Unit::of("number", "proc-macro", &[])),
            "the features of `number` are not compiled there and [] on the device"
        );
    }

    #[test]
    fn every_source_is_patched_by_what_came_out() {
        let tables = |version: &str, source: Option<&str>| patch_tables(&original(version, source).patches(), None);
        assert_eq!(tables("1.0.0", Some(CRATES_IO)), "");
        let head = "\n[patch.\"crates-io\"]\n\"number\" = { package = \"number\", ";
        assert_eq!(tables("1.0.0", None), format!("{head}path = \"/nowhere/number\" }}\n"));
        for (query, reference) in [
            ("", ""),
            ("?branch=side%2F1.0", ", branch = \"side/1.0\""),
            ("?tag=v1", ", tag = \"v1\""),
            ("?rev=0123", ", rev = \"0123\""),
        ] {
            let source = format!("git+https://x.y/z{query}#0123");
            let wanted = format!("{head}git = \"https://x.y/z\"{reference} }}\n");
            assert_eq!(tables("1.0.0", Some(&source)), wanted);
        }
        let other = "registry+https://x.y/index";
        let wanted = format!("{head}version = \"=1.0.0\", registry-index = \"https://x.y/index\" }}\n");
        assert_eq!(tables("1.0.0+build", Some(other)), wanted);
    }
}
