//! What tells apart things of one name, and is the same in host and device builds.

use proc_macro2::Span;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Eight digits that tell apart things of one name, the same in host and device builds: they come from the package and
/// from the file in it, not from how a compiler prints tokens or where the package lies on disk, and not from the line, so that they
/// stay as they are when other code of the file is edited. Of several of one name in one file, the digits follow from how many came before.
pub fn place(span: Span, name: &str) -> String {
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    let mut mix = |text: &str| {
        for byte in text.bytes().chain([0]) {
            hash = (hash ^ byte as u64).wrapping_mul(0x100_0000_01b3);
        }
    };
    mix(name);
    for package in ["CARGO_PKG_NAME", "CARGO_PKG_VERSION"] {
        mix(&std::env::var(package).unwrap_or_default());
    }
    if proc_macro::is_available() {
        let span = span.unwrap();
        let file = span.local_file().unwrap_or_else(|| span.file().into());
        let root = |variable| std::env::var_os(variable).map(PathBuf::from);
        let file = in_package(&file, root("OUT_DIR").as_deref(), root("CARGO_MANIFEST_DIR").as_deref());
        file.iter().rev().for_each(|part| mix(&part.to_string_lossy()));
    }
    static GIVEN: Mutex<BTreeSet<u32>> = Mutex::new(BTreeSet::new());
    let mut given = GIVEN.lock().unwrap_or_else(PoisonError::into_inner);
    loop {
        let digits = (hash ^ hash >> 32) as u32;
        if given.insert(digits) {
            return format!("{digits:08x}");
        }
        hash = hash.wrapping_mul(0x100_0000_01b3) ^ 1;
    }
}

/// Where a source file is in its package, or in the folder `out` of what its build script has written. rustc is told the file
/// relative to the workspace or with its whole path, as cargo likes, and each build has an `out` of its own.
fn in_package(file: &Path, out: Option<&Path>, package: Option<&Path>) -> PathBuf {
    let file = std::path::absolute(file).unwrap_or_else(|_| file.to_path_buf());
    let real = |path: &Path| std::fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    // As it was written if that will do: a link in a package is a file of it, wherever it leads.
    let inside = |root: &Path| {
        let written = file.strip_prefix(root).map(Path::to_path_buf);
        written.or_else(|_| real(&file).strip_prefix(real(root)).map(Path::to_path_buf)).ok()
    };
    if let Some(found) = out.and_then(inside).or_else(|| package.and_then(inside)) {
        return found;
    }
    let Some(package) = package.map(real) else {
        // Cargo does not run this: folders further up are the machine's.
        let parts: Vec<_> = file.iter().rev().take(2).collect();
        return parts.into_iter().rev().collect();
    };
    let file = real(&file);
    let common = file.iter().zip(&package).take_while(|(a, b)| a == b).count();
    package.iter().skip(common).map(|_| "..".as_ref()).chain(file.iter().skip(common)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_found_in_their_package() {
        let root = std::env::current_dir().unwrap();
        let at = |path: &str| root.join(path);
        let found = |file: &Path| in_package(file, Some(&at("target/out")), Some(&at("shaders")));
        for (file, expected) in [
            ("shaders/lib.rs", "lib.rs"),
            ("shaders/src/lib.rs", "src/lib.rs"),
            ("shaders/src/../../common/deep/x.rs", "src/../../common/deep/x.rs"),
            ("target/out/made/x.rs", "made/x.rs"),
            ("common/x.rs", "../common/x.rs"),
        ] {
            // With its whole path, and relative to where rustc runs.
            assert_eq!(found(&at(file)), Path::new(expected));
            assert_eq!(found(Path::new(file)), Path::new(expected));
        }
        assert_eq!(in_package(&at("a/b/c.rs"), None, None), Path::new("b/c.rs"));
    }

    #[test]
    #[cfg(unix)]
    fn a_package_may_have_two_paths() {
        let dir = std::env::temp_dir().join(format!("optix-place-{}", std::process::id()));
        std::fs::create_dir_all(dir.join("real")).unwrap();
        std::fs::write(dir.join("real/lib.rs"), "").unwrap();
        std::os::unix::fs::symlink(dir.join("real"), dir.join("link")).unwrap();
        for (file, package) in [("real", "link"), ("link", "real"), ("link", "link")] {
            let file = dir.join(file).join("lib.rs");
            assert_eq!(in_package(&file, None, Some(&dir.join(package))), Path::new("lib.rs"));
        }
        std::fs::remove_dir_all(dir).unwrap();
    }
}
