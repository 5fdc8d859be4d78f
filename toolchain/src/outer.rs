//! The build of the host program, which a build script is a part of.
//!
//! A device build has to read the same configuration and see the same features as the build of the host program. Cargo
//! tells a build script the package, its features and the flags. It does not tell where it was started, which decides
//! which configuration files count, nor options such as `--config`. On Linux these are read from the process that runs
//! the build script.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

#[cfg_attr(not(target_os = "linux"), allow(unused_imports))]
use crate::cargo;
use crate::metadata::{Package, Workspace};
use crate::options::Shaders;

/// What is known of the build of the host program.
#[derive(Clone, Debug)]
pub(crate) struct Outer {
    /// The manifest of the package that is built.
    pub manifest: PathBuf,
    /// The package's name.
    pub name: String,
    /// Its features that are on, as environment variables spell them: `F16_TEXTURES`.
    pub features: Vec<String>,
    /// The profile's name.
    pub profile: String,
    /// The target, if it is not the host itself.
    pub target: Option<String>,
    /// Where cargo was started, if that is known.
    pub dir: Option<PathBuf>,
    /// Those of cargo's options that nested cargos have to be given too.
    pub options: Vec<OsString>,
}

impl Outer {
    /// The build that this process is a build script of.
    pub fn of_build_script() -> Option<Self> {
        let variable = |name: &str| std::env::var(name).ok();
        let features = std::env::vars_os().filter_map(|(name, _)| {
            let name = name.into_string().ok()?;
            name.strip_prefix("CARGO_FEATURE_").map(str::to_string)
        });
        let out_dir = PathBuf::from(std::env::var_os("OUT_DIR")?);
        let (dir, options) = parent().map_or((None, Vec::new()), |(dir, options)| (Some(dir), options));
        Some(Self {
            manifest: PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR")?).join("Cargo.toml"),
            name: variable("CARGO_PKG_NAME")?,
            features: features.collect(),
            profile: profile(&out_dir, &variable("PROFILE")?),
            target: variable("TARGET").filter(|target| Some(target) != variable("HOST").as_ref()),
            dir,
            options,
        })
    }

    /// Whether the command line of cargo has `--config`.
    pub fn has_configuration(&self) -> bool {
        self.options.iter().any(|option| option.to_string_lossy().starts_with("--config"))
    }

    /// The options with which cargo switches on the features of the package, and those of the shader crate in `dir`.
    pub fn feature_options(&self, shaders: &Shaders, dir: &Path, manifests: &Workspace) -> Vec<String> {
        let mut on = Vec::new();
        for package in &manifests.packages {
            let mut add = |feature: &str| on.push(format!("{}/{feature}", package.name));
            if package.manifest == self.manifest {
                self.features(package).for_each(&mut add);
            }
            if std::fs::canonicalize(package.dir()).is_ok_and(|real| real == dir) {
                let default =
                    shaders.default_features != Some(false) && package.features.iter().any(|f| f == "default");
                default.then(|| add("default"));
                shaders.features.iter().flatten().for_each(|feature| add(feature));
            }
        }
        vec!["--no-default-features".to_string(), format!("--features={}", on.join(","))]
    }

    /// The package's features that are on.
    pub fn features<'a>(&'a self, package: &'a Package) -> impl Iterator<Item = &'a str> {
        let variable = |feature: &str| feature.to_uppercase().replace('-', "_");
        let is_on = move |feature: &&String| self.features.contains(&variable(feature));
        package.features.iter().filter(is_on).map(String::as_str)
    }
}

/// The name of the profile whose output folder has `out_dir`. (`PROFILE` only tells `debug` or `release`, from which a
/// custom profile inherits.)
fn profile(out_dir: &Path, base: &str) -> String {
    let build = out_dir.ancestors().find(|dir| dir.file_name().is_some_and(|name| name == "build"));
    let folder = build.and_then(Path::parent).and_then(Path::file_name).and_then(|name| name.to_str());
    match folder.unwrap_or(base) {
        "debug" => "dev".to_string(),
        other => other.to_string(),
    }
}

/// Where the cargo that runs this process was started, and those of its options that nested cargos need.
#[cfg(target_os = "linux")]
fn parent() -> Option<(PathBuf, Vec<OsString>)> {
    use std::os::unix::ffi::OsStringExt;

    let process = PathBuf::from(format!("/proc/{}", std::os::unix::process::parent_id()));
    let program = std::fs::read_link(process.join("exe")).ok()?;
    if program.file_stem().is_none_or(|name| name != "cargo") {
        return None;
    }
    let line = std::fs::read(process.join("cmdline")).ok()?;
    let words = line.split(|byte| *byte == 0).map(|word| OsString::from_vec(word.to_vec()));
    let dir = std::fs::read_link(process.join("cwd")).ok()?;
    let options = cargo::elsewhere(&options(words.skip(1)), &dir);
    Some((dir, options))
}

#[cfg(not(target_os = "linux"))]
fn parent() -> Option<(PathBuf, Vec<OsString>)> {
    None
}

/// The options on a command line that say how packages are found.
#[cfg_attr(not(target_os = "linux"), allow(dead_code))]
fn options(mut words: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let mut options = Vec::new();
    while let Some(word) = words.next() {
        let text = word.to_string_lossy().into_owned();
        // `--frozen` and `--locked` are about the user's lock file, and the nested package has its own.
        match text.as_str() {
            "--" => break,
            "--config" => options.extend([Some(word), words.next()].into_iter().flatten()),
            "--offline" => options.push(word),
            "--frozen" => options.push("--offline".into()),
            // `-Zbuild-std` and its like do not count: the toolchain compiles `core` itself.
            "-Z" => match words.next() {
                Some(flag) if !flag.to_string_lossy().starts_with("build-std") => options.extend([word, flag]),
                _ => {}
            },
            text if text.starts_with("--config=") => options.push(word),
            text if text.starts_with("-Z") && !text.starts_with("-Zbuild-std") => options.push(word),
            _ => {}
        }
    }
    options
}

/// Those of the user's `RUSTFLAGS` that decide which code is compiled. Those that tell how to compile for the host's
/// processor are left out.
pub(crate) fn flags() -> Vec<String> {
    let encoded = std::env::var("CARGO_ENCODED_RUSTFLAGS");
    match (encoded, std::env::var("RUSTFLAGS")) {
        (Ok(flags), _) => relevant(flags.split('\x1f')),
        (_, Ok(flags)) => relevant(flags.split_whitespace()),
        _ => Vec::new(),
    }
}

fn relevant<'a>(mut flags: impl Iterator<Item = &'a str>) -> Vec<String> {
    let is_relevant = |option: &str, value: &str| match option {
        "--cfg" | "--check-cfg" => true,
        _ => matches!(value.split('=').next(), Some("debug-assertions" | "overflow-checks")),
    };
    let mut found = Vec::new();
    while let Some(flag) = flags.next() {
        let (option, value) = match flag {
            "--cfg" | "--check-cfg" | "-C" | "--codegen" => (flag, flags.next()),
            _ => match flag.split_once('=') {
                Some((option @ ("--cfg" | "--check-cfg" | "--codegen"), value)) => (option, Some(value)),
                _ => ("-C", flag.strip_prefix("-C")),
            },
        };
        if let Some(value) = value.filter(|value| is_relevant(option, value)) {
            found.extend([option.to_string(), value.to_string()]);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_of_the_outer_cargo() {
        let words = |line: &str| line.split(' ').map(OsString::from).collect::<Vec<_>>();
        let found = |line: &str| options(words(line).into_iter());
        assert_eq!(found("build --release -p x --features y"), [""; 0].map(OsString::from));
        assert_eq!(
            found("--config a=1 run --config=b.toml --frozen -Z bindeps -Zbuild-std=core -Z build-std -- --config c"),
            words("--config a=1 --config=b.toml --offline -Z bindeps")
        );
        assert_eq!(found("build --config"), words("--config"));
    }

    #[test]
    fn flags_that_choose_code_are_taken() {
        let found = |line: &str| relevant(line.split(' ')).join(" ");
        assert_eq!(
            found("-Ctarget-cpu=x86-64-v2 --cfg odd -C overflow-checks -Clinker=x --cfg=a=\"b\""),
            "--cfg odd -C overflow-checks --cfg a=\"b\""
        );
        assert_eq!(
            found("-Cdebug-assertions=off --codegen debug-assertions=on -C opt-level=1 -L x"),
            "-C debug-assertions=off --codegen debug-assertions=on"
        );
        assert_eq!(found("--cfg"), "");
    }

    #[test]
    fn profiles_have_their_own_name() {
        let profile = |dir: &str| super::profile(Path::new(dir), "release");
        assert_eq!(profile("/t/x86_64-unknown-linux-gnu/fast/build/host-0123/out"), "fast");
        assert_eq!(profile("/build/t/debug/build/host-0123/out"), "dev");
        assert_eq!(profile("/t/release/build/host/0123/out"), "release");
        assert_eq!(profile("/elsewhere/out"), "release");
    }
}
