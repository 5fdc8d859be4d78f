//! Lock files of wrapper packages: the user's, so that versions agree, with `libm` replaced.

use std::path::Path;

use crate::error::Error;
use crate::util;

/// Writes `text` as the lock file of the package in `dir`, unless that was done before. Cargo adds to the file what the
/// package needs besides, and that must not be lost.
pub(crate) fn seed(dir: &Path, text: &str) -> Result<(), Error> {
    if util::write_if_changed(&dir.join("Cargo.lock.seed"), text)? || !dir.join("Cargo.lock").exists() {
        util::write_if_changed(&dir.join("Cargo.lock"), text)?;
    }
    Ok(())
}

/// The lock file in which `libm` of this version comes from a path and depends on the package `software`.
///
/// Without this, cargo would keep the version from the registry that is locked, and ignore the `[patch]`.
pub(crate) fn with_patched_libm(lock: &str, version: &str, software: &str) -> String {
    let block = format!("name = \"libm\"\nversion = \"{version}\"\n");
    let mut out = String::new();
    for package in lock.split_inclusive("\n\n") {
        if package.contains(&block) {
            out.push_str(&format!("[[package]]\n{block}dependencies = [\n \"{software}\",\n]\n\n"));
            out.push_str(&format!("[[package]]\nname = \"{software}\"\nversion = \"{version}\"\n\n"));
        } else {
            out.push_str(package);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn libm_loses_its_registry_and_nothing_else_changes() {
        let lock = "version = 4\n\n[[package]]\nname = \"glam\"\nversion = \"0.34.3\"\ndependencies = [\n \"libm\",\n]\n\n\
                    [[package]]\nname = \"libm\"\nversion = \"0.2.16\"\nsource = \"registry+x\"\nchecksum = \"y\"\n\n\
                    [[package]]\nname = \"z\"\nversion = \"1.0.0\"\n";
        let patched = with_patched_libm(lock, "0.2.16", "soft");
        assert!(!patched.contains("registry"));
        assert!(patched.contains("name = \"libm\"\nversion = \"0.2.16\"\ndependencies = [\n \"soft\",\n]\n"));
        assert!(patched.contains("name = \"soft\"\nversion = \"0.2.16\"\n"));
        assert!(patched.contains("name = \"glam\"") && patched.ends_with("name = \"z\"\nversion = \"1.0.0\"\n"));
    }
}
