//! Host and device are made from the same: whatever decides about sources, features and checks of the host program reaches the
//! device build, or is an error.
//!
//! Each test is a workspace with a program and its shader crate, which depends on the crate `number` of a registry. The program
//! says which number the host has; its PTX has the device's.

mod common;

use std::cell::RefCell;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What the registry has.
const OF_REGISTRY: u32 = 71_001;

const SHADERS: &str = r#"#![no_std]

pub fn number() -> u32 {
    number::number()
}

#[cfg(target_arch = "nvptx64")]
mod device {
    #[unsafe(no_mangle)]
    pub unsafe extern "ptx-kernel" fn __raygen__camera() {
        unsafe { core::arch::asm!("call _optix_set_payload, ({}, {});", in(reg32) 0, in(reg32) super::number()) };
    }

    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo) -> ! {
        loop {}
    }
}
"#;

const MAIN: &str =
    "fn main() { println!(\"{}\", shaders::number()); print!(\"{}\", include_str!(env!(\"OPTIX_PTX_shaders\"))); }\n";

struct Project {
    dir: PathBuf,
    /// Where cargo runs.
    at: PathBuf,
    environment: Vec<(&'static str, String)>,
}

/// Waits until no other test's thread is left that asked before.
///
/// The programs have one name and one folder, and cargo takes sources that were written before another test's build of a crate with
/// the same name and place in its workspace for that crate's.
fn wait_for_turn() {
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    thread_local! {
        static TURN: RefCell<Option<MutexGuard<'static, ()>>> = const { RefCell::new(None) };
    }
    TURN.with_borrow_mut(|turn| {
        turn.get_or_insert_with(|| ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner));
    });
}

/// The workspace. None: this machine can't compile for the device.
fn project(name: &str) -> Option<Project> {
    wait_for_turn();
    let dir = common::can_compile(name).then(|| common::folder(&format!("agreement-{name}")))?;
    let project = Project { at: dir.clone(), dir, environment: Vec::new() };
    project.write("Cargo.toml", "[workspace]\nmembers = [\"host\", \"shaders\"]\nresolver = \"3\"\n");
    project.package("host", "[dependencies]\nshaders = { path = \"../shaders\" }\n", "");
    project.write("host/src/main.rs", MAIN);
    project.write("host/build.rs", "fn main() { optix_toolchain::shaders(\"../shaders\") }\n");
    fs::remove_file(project.dir.join("host/src/lib.rs")).expect("it was there");
    project.package("shaders", "[dependencies]\nnumber = \"1\"\n", SHADERS);
    project.registry("number", "1.0.0", "", &number(OF_REGISTRY));
    let config = "[source.crates-io]\nreplace-with = \"here\"\n\n[source.here]\ndirectory = \"registry\"\n";
    project.write(".cargo/config.toml", config);
    Some(project)
}

fn number(number: u32) -> String {
    format!("#![no_std]\npub fn number() -> u32 {{ {number} }}\n")
}

impl Project {
    fn write(&self, file: &str, text: &str) {
        let file = self.dir.join(file);
        fs::create_dir_all(file.parent().expect("a folder")).expect("writable");
        fs::write(file, text).expect("writable");
    }

    fn add(&self, file: &str, text: &str) {
        let old = fs::read_to_string(self.dir.join(file)).expect("readable");
        self.write(file, &(old + text));
    }

    fn edit(&self, file: &str, from: &str, to: &str) {
        let text = fs::read_to_string(self.dir.join(file)).expect("readable");
        assert!(text.contains(from), "{from} in {text}");
        self.write(file, &text.replace(from, to));
    }

    /// A package in a folder.
    fn package(&self, folder: &str, more: &str, source: &str) {
        let name = Path::new(folder).file_name().expect("a name").to_string_lossy();
        let build = format!(
            "\n[build-dependencies]\noptix-toolchain = {{ path = '{}', default-features = false }}\n",
            env!("CARGO_MANIFEST_DIR")
        );
        let build = if name == "host" { build.as_str() } else { "" };
        let manifest =
            format!("[package]\nname = \"{name}\"\nversion = \"1.0.0\"\nedition = \"2024\"\n\n{more}{build}");
        self.write(&format!("{folder}/Cargo.toml"), &manifest);
        self.write(&format!("{folder}/src/lib.rs"), source);
    }

    /// A package of the registry. Cargo takes these for unchangeable, so a test with another source needs another version.
    fn registry(&self, name: &str, version: &str, more: &str, source: &str) {
        let folder = format!("registry/{name}-{version}");
        self.write("registry/none", "");
        let manifest = format!("[package]\nname = \"{name}\"\nversion = \"{version}\"\nedition = \"2024\"\n\n{more}");
        self.write(&format!("{folder}/Cargo.toml"), &manifest);
        self.write(&format!("{folder}/src/lib.rs"), source);
        self.write(
            &format!("{folder}/.cargo-checksum.json"),
            &format!("{{\"files\":{{}},\"package\":\"{:064x}\"}}", 7),
        );
    }

    fn cargo(&self, args: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO"));
        command.args(args).current_dir(&self.at).env("CARGO_TERM_COLOR", "never").env("CARGO_NET_OFFLINE", "true");
        for name in ["RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS", "OPTIX_RUSTC"] {
            command.env_remove(name);
        }
        command
            .env("CARGO_TARGET_DIR", common::projects())
            .envs(self.environment.iter().map(|(name, value)| (name, value)));
        command.output().expect("cargo runs")
    }

    /// Runs the program: the host's number is this, and the device's too.
    #[track_caller]
    fn agrees_on(&self, number: u32, args: &[&str]) {
        let output = self.cargo(&[&["run", "--package", "host"], args].concat());
        let (out, error) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert!(output.status.success(), "{error}");
        let (host, ptx) = out.split_once('\n').expect("two parts");
        assert_eq!(host, number.to_string(), "the host; {error}");
        assert!(ptx.contains(&format!(" {number};")), "the device has not {number}: {ptx}");
    }

    /// The build fails and says this.
    #[track_caller]
    fn refuses(&self, says: &[&str], args: &[&str]) {
        let output = self.cargo(&[&["build", "--package", "host"], args].concat());
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success(), "it builds");
        for part in says {
            assert!(error.contains(part), "`{part}` is not in: {error}");
        }
    }
}

#[test]
fn patches_reach_the_device() {
    let Some(project) = project("patch") else { return };
    project.agrees_on(OF_REGISTRY, &[]);
    project.package("number", "", &number(71_002));
    project.add("Cargo.toml", "exclude = [\"number\"]\n\n[patch.crates-io]\nnumber = { path = \"number\" }\n");
    project.agrees_on(71_002, &[]);
    // Nothing is left of it.
    project.edit("Cargo.toml", "[patch.crates-io]\nnumber =", "[x]\nx =");
    project.agrees_on(OF_REGISTRY, &[]);
}

#[test]
fn patches_in_configuration_reach_the_device() {
    let Some(mut project) = project("patch-config") else { return };
    project.package("number", "", &number(71_003));
    project.add("Cargo.toml", "exclude = [\"number\", \"other\"]\n");
    let patch = "\n[patch.crates-io]\nnumber = { path = \"number\" }\n";
    project.add(".cargo/config.toml", patch);
    project.agrees_on(71_003, &[]);
    // One of the manifest gives way to it.
    project.package("other", "", &number(71_004));
    project.add("Cargo.toml", "\n[patch.crates-io]\nnumber = { path = \"other\" }\n");
    project.edit("other/Cargo.toml", "name = \"other\"", "name = \"number\"");
    project.agrees_on(71_003, &[]);

    project.edit(".cargo/config.toml", patch, "");
    project.agrees_on(71_004, &[]);

    // On the command line, and in a folder that cargo is started in.
    project.edit("Cargo.toml", "[patch.crates-io]\nnumber =", "[x]\nx =");
    let option = format!("patch.crates-io.number.path={:?}", project.dir.join("number"));
    project.agrees_on(71_003, &["--config", &option]);
    project.agrees_on(OF_REGISTRY, &[]);
    project.write("below/.cargo/config.toml", patch);
    project.edit("below/.cargo/config.toml", "\"number\"", "\"../number\"");
    project.at = project.dir.join("below");
    project.agrees_on(71_003, &["--manifest-path", "../Cargo.toml"]);
}

#[test]
fn patches_by_git_and_of_other_versions_reach_the_device() {
    let Some(project) = project("patch-git") else { return };
    project.package("repository", "", &number(71_005));
    project.edit(
        "repository/Cargo.toml",
        "name = \"repository\"\nversion = \"1.0.0\"",
        "name = \"number\"\nversion = \"1.7.0\"",
    );
    project.write("repository/.gitignore", "/target\n");
    let git = |line: &str| {
        let mut command = Command::new("git");
        command.args(["-c", "user.name=x", "-c", "user.email=x@y", "-c", "init.defaultBranch=main"]);
        command
            .args(line.split(' '))
            .current_dir(project.dir.join("repository"))
            .output()
            .is_ok_and(|o| o.status.success())
    };
    if !["init -q", "add .", "commit -q -m x", "branch side/1.0"].into_iter().all(git) {
        return eprintln!("patches by git: not run, there is no git");
    }
    let address = format!("file://{}", project.dir.join("repository").display());
    let patch = format!(
        "exclude = [\"repository\"]\n\n[patch.crates-io]\nnumber = {{ git = '{address}', branch = 'side/1.0' }}\n"
    );
    project.add("Cargo.toml", &patch);
    // A repository that is a file's needs no network.
    let mut project = project;
    project.environment.push(("CARGO_NET_OFFLINE", "false".into()));
    project.environment.push(("CARGO_HOME", project.dir.join("home").display().to_string()));
    project.agrees_on(71_005, &[]);
    project.agrees_on(71_005, &["--offline"]);
}

#[test]
fn replacements_and_overrides_reach_the_device() {
    let Some(project) = project("replace") else { return };
    project.package("number", "", &number(71_006));
    project.add("Cargo.toml", "exclude = [\"number\"]\n");
    project.add(".cargo/config.toml", &format!("\npaths = [{:?}]\n", project.dir.join("number")));
    // The first key of a table, where it belongs.
    let config = fs::read_to_string(project.dir.join(".cargo/config.toml")).expect("readable");
    let (tables, paths) = config.split_once("\npaths").expect("both");
    project.write(".cargo/config.toml", &format!("paths{paths}\n{tables}"));
    project.agrees_on(71_006, &[]);

    project.write(".cargo/config.toml", tables);
    project.add("Cargo.toml", "\n[replace]\n\"number:1.0.0\" = { path = \"number\" }\n");
    project.agrees_on(71_006, &[]);
}

#[test]
fn the_lock_file_decides_about_versions() {
    let Some(project) = project("lock") else { return };
    project.agrees_on(OF_REGISTRY, &[]);
    project.registry("number", "1.0.10", "", &number(71_007));
    project.agrees_on(OF_REGISTRY, &["--locked"]);
    fs::remove_file(project.dir.join("Cargo.lock")).expect("it is there");
    project.agrees_on(71_007, &[]);
    project.agrees_on(71_007, &["--frozen"]);
}

#[test]
fn features_are_those_of_the_program() {
    let Some(project) = project("features") else { return };
    let number = "#![no_std]\npub fn number() -> u32 { if cfg!(feature = \"fast\") { 71_009 } else { 71_008 } }\n";
    project.registry("number", "1.0.11", "[features]\nfast = []\n", number);
    project.package(
        "shaders",
        "[dependencies]\nnumber = \"1\"\n\n[features]\ndefault = []\nquick = [\"number/fast\"]\n",
        SHADERS,
    );
    project.agrees_on(71_008, &[]);
    // By the program's own feature.
    project.edit("host/Cargo.toml", "[dependencies]", "[features]\nso-quick = [\"shaders/quick\"]\n\n[dependencies]");
    project.agrees_on(71_009, &["--features", "so-quick"]);
    project.agrees_on(71_008, &[]);
    // By the dependency.
    project.edit("host/Cargo.toml", "path = \"../shaders\"", "path = \"../shaders\", features = [\"quick\"]");
    project.agrees_on(71_009, &[]);
    // What the build script says must be the same.
    let script =
        |call: &str| format!("fn main() {{ optix_toolchain::Shaders::new(\"../shaders\"){call}.compile() }}\n");
    let with = |call: &str| {
        project.write("host/other.rs", &script(call));
        project.edit("host/Cargo.toml", "edition = \"2024\"\n", "edition = \"2024\"\nbuild = \"other.rs\"\n");
    };
    with(".features([\"quick\"])");
    project.agrees_on(71_009, &[]);
    project.write("host/other.rs", &script(".features([\"default\"])"));
    project.refuses(
        &["its feature `quick` is on in the program that is built only", "host and device would run different code"],
        &[],
    );

    // A feature that only a build dependency asks for counts in workspaces that say so.
    let Some(project) = self::project("resolver") else { return };
    project.registry("number", "1.0.12", "[features]\nfast = []\n", number);
    project.edit("Cargo.toml", "\"3\"", "\"1\"");
    project.package(
        "shaders",
        "[dependencies]\nnumber = \"1\"\n\n[build-dependencies]\nnumber = { version = \"1\", features = [\"fast\"] }\n",
        SHADERS,
    );
    project.write("shaders/build.rs", "fn main() { assert_eq!(number::number(), 71_009) }\n");
    project.agrees_on(71_009, &[]);
    project.edit("Cargo.toml", "\"1\"", "\"2\"");
    project.agrees_on(71_008, &[]);
}

#[test]
fn checks_are_those_of_the_profile() {
    let Some(mut project) = project("profile") else { return };
    let debug = "#![no_std]\npub fn number() -> u32 { if cfg!(debug_assertions) { 71_011 } else { 71_010 } }\n";
    project.registry("number", "1.0.13", "", debug);
    project.agrees_on(71_011, &[]);
    project.agrees_on(71_010, &["--release"]);
    project.add("Cargo.toml", "\n[profile.dev.package.number]\ndebug-assertions = false\n\n[profile.release]\ndebug-assertions = true\n\n[profile.mine]\ninherits = \"dev\"\n");
    project.agrees_on(71_010, &[]);
    project.agrees_on(71_011, &["--release"]);
    project.agrees_on(71_010, &["--profile", "mine"]);
    project.environment.push(("CARGO_PROFILE_RELEASE_DEBUG_ASSERTIONS", "false".into()));
    project.agrees_on(71_010, &["--release"]);
    project.environment = vec![("RUSTFLAGS", "-Cdebug-assertions=off".into())];
    project.agrees_on(71_010, &["--release"]);
}

#[test]
fn flags_and_variables_that_choose_code_reach_the_device() {
    let Some(mut project) = project("flags") else { return };
    let number = "#![no_std]\npub fn number() -> u32 { if cfg!(odd) { 71_013 } else if option_env!(\"KIND\").is_some() { 71_014 } \
                  else if option_env!(\"PROFILE\").is_some() { 71_015 } else { 71_012 } }\n";
    project.registry("number", "1.0.14", "", number);
    project.agrees_on(71_012, &[]);
    project.environment.push(("RUSTFLAGS", "-Ctarget-cpu=x86-64-v2 --cfg odd".into()));
    project.agrees_on(71_013, &[]);
    project.environment.clear();
    project.add(".cargo/config.toml", "\n[env]\nKIND = \"other\"\n");
    project.agrees_on(71_014, &[]);
}

#[test]
fn workspaces_of_every_shape() {
    // A dependency that is inherited.
    let Some(project) = project("inherited") else { return };
    project.add("Cargo.toml", "\n[workspace.dependencies]\nnumber = { path = \"number\" }\n");
    project.package("number", "", &number(71_016));
    project.edit("shaders/Cargo.toml", "number = \"1\"", "number.workspace = true");
    project.edit("Cargo.toml", "\"shaders\"]", "\"shaders\", \"number\"]");
    project.agrees_on(71_016, &[]);

    // The shader crate is a workspace of its own, with a patch and a lock file that do not count in the program's.
    let Some(mut project) = self::project("outside") else { return };
    project.edit("Cargo.toml", "\"host\", \"shaders\"]", "\"host\"]\nexclude = [\"shaders\", \"mine\", \"theirs\"]");
    for (folder, value) in [("mine", 71_017), ("theirs", 71_018)] {
        project.package(folder, "", &number(value));
        project.edit(&format!("{folder}/Cargo.toml"), &format!("name = \"{folder}\""), "name = \"number\"");
    }
    project.add("shaders/Cargo.toml", "\n[workspace]\n\n[patch.crates-io]\nnumber = { path = \"../theirs\" }\n");
    project.agrees_on(OF_REGISTRY, &[]);
    project.add("Cargo.toml", "\n[patch.crates-io]\nnumber = { path = \"mine\" }\n");
    project.agrees_on(71_017, &[]);
    assert!(!project.dir.join("shaders/Cargo.lock").exists(), "the shader crate's folder is left alone");

    // By way of a link.
    #[cfg(unix)]
    {
        let link = project.dir.with_file_name("agreement-link");
        let _ = fs::remove_file(&link);
        std::os::unix::fs::symlink(&project.dir, &link).expect("links can be made");
        project.at = link;
        project.agrees_on(71_017, &[]);
    }

    // Names with what separates elsewhere.
    let Some(project) = self::project("na,me = 1;2") else { return };
    project.agrees_on(OF_REGISTRY, &[]);
}
