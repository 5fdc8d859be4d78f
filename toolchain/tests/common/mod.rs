//! Copies of the fixture in folders of their own.
#![allow(dead_code, reason = "each test is a crate of its own and uses a part")]

use std::fs;
use std::path::{Path, PathBuf};

/// Where device builds go: the workspace's own area, so that `core` is compiled once for all.
pub fn area() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("optix")
}

/// The target directory of projects, with the device area of the workspace in it.
pub fn projects() -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join("projects");
    fs::create_dir_all(&dir).expect("writable");
    fs::create_dir_all(area()).expect("writable");
    // It may be there from the last run; where links can't be made, a test compiles its own `core`.
    #[cfg(unix)]
    let _ = std::os::unix::fs::symlink(area(), dir.join("optix"));
    dir
}

/// An empty folder for the test `name`.
pub fn folder(name: &str) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&dir);
    fs::create_dir_all(&dir).expect("the folder for tests is writable");
    dir
}

/// A fresh copy of the fixture's shader crate in `dir`.
pub fn shader_crate(dir: &Path) -> PathBuf {
    let shaders = dir.join("shaders");
    fs::create_dir_all(shaders.join("src")).expect("writable");
    for file in ["Cargo.toml", "src/lib.rs"] {
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixture").join(file);
        fs::copy(from, shaders.join(file)).expect("the fixture is there");
    }
    // The versions that are downloaded already.
    let lock = Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.lock");
    let _ = fs::copy(lock, shaders.join("Cargo.lock"));
    // Cargo removes the others, as it would for a user.
    let mut cargo = std::process::Command::new(env!("CARGO"));
    cargo.args(["metadata", "--offline", "--format-version", "1"]).current_dir(&shaders);
    assert!(cargo.output().expect("cargo runs").status.success());
    shaders
}

/// Replaces text in the shader crate's source.
pub fn edit(shaders: &Path, from: &str, to: &str) {
    let file = shaders.join("src/lib.rs");
    let text = fs::read_to_string(&file).expect("readable");
    assert!(text.contains(from), "{from}");
    fs::write(&file, text.replace(from, to)).expect("writable");
}

/// Whether this machine can compile for the device. If not, says that the test `name` did not run.
pub fn can_compile(name: &str) -> bool {
    let found = optix_toolchain::DeviceCompiler::find();
    if let Err(error) = &found {
        eprintln!("{name}: not run: {error}");
    }
    found.is_ok()
}
