//! Files, names and hashes.

use std::fs::{self, File};
use std::path::{Path, PathBuf};

use crate::error::{Doing, Error};

/// Writes `text` unless the file has it already, so that cargo sees an unchanged file as unchanged.
/// Returns whether it wrote.
pub(crate) fn write_if_changed(path: &Path, text: &str) -> Result<bool, Error> {
    if fs::read_to_string(path).is_ok_and(|old| old == text) {
        return Ok(false);
    }
    if let Some(parent) = path.parent() {
        create_dir(parent)?;
    }
    fs::write(path, text).doing(|| format!("cannot write {}", path.display()))?;
    Ok(true)
}

pub(crate) fn create_dir(path: &Path) -> Result<(), Error> {
    fs::create_dir_all(path).doing(|| format!("cannot create the folder {}", path.display()))
}

/// Whether files can be created in a folder, which is created if it is not there.
pub(crate) fn is_writable(dir: &Path) -> bool {
    let probe = dir.join(format!(".writable-{}", std::process::id()));
    let writable = create_dir(dir).is_ok() && fs::write(&probe, "").is_ok();
    let _ = fs::remove_file(probe);
    writable
}

pub(crate) fn read(path: &Path) -> Result<String, Error> {
    fs::read_to_string(path).doing(|| format!("cannot read {}", path.display()))
}

/// Copies a folder with everything in it.
pub(crate) fn copy_dir(from: &Path, to: &Path) -> Result<(), Error> {
    create_dir(to)?;
    let entries = fs::read_dir(from).doing(|| format!("cannot list {}", from.display()))?;
    for entry in entries {
        let entry = entry.doing(|| format!("cannot list {}", from.display()))?;
        let (path, target) = (entry.path(), to.join(entry.file_name()));
        if path.is_dir() {
            copy_dir(&path, &target)?;
        } else {
            fs::copy(&path, &target).doing(|| format!("cannot copy {}", path.display()))?;
        }
    }
    Ok(())
}

/// Whether `is` holds for the text of a Rust source in a folder, or in a folder inside it.
pub(crate) fn any_source(dir: &Path, is: &dyn Fn(&str) -> bool) -> bool {
    let entries = fs::read_dir(dir).into_iter().flatten().flatten().map(|entry| entry.path());
    entries.into_iter().any(|path| match path.extension() {
        Some(extension) if extension == "rs" => fs::read_to_string(&path).is_ok_and(|text| is(&text)),
        _ => path.is_dir() && any_source(&path, is),
    })
}

/// Waits for and takes an exclusive lock on `path`; it is released on drop, or when the process ends.
pub(crate) fn lock(path: &Path) -> Result<File, Error> {
    if let Some(parent) = path.parent() {
        create_dir(parent)?;
    }
    let doing = || format!("cannot lock {}", path.display());
    let file = File::options().create(true).append(true).open(path).doing(doing)?;
    file.lock().doing(doing)?;
    Ok(file)
}

/// The FNV-1a hash of the parts, as 16 hexadecimal digits. It names folders, so it has to be the same on every machine
/// and in every version.
pub(crate) fn hash<'a>(parts: impl IntoIterator<Item = &'a str>) -> String {
    let mut state = 0xcbf2_9ce4_8422_2325_u64;
    for part in parts {
        // The zero byte keeps ["ab", "c"] and ["a", "bc"] apart.
        for byte in part.bytes().chain([0]) {
            state = (state ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
    format!("{state:016x}")
}

/// A TOML basic string, with its quotes.
pub(crate) fn toml_string(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '\\' | '"' => quoted.extend(['\\', c]),
            c if c.is_control() => quoted.push_str(&format!("\\u{:04X}", u32::from(c))),
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

/// The target directory that holds `out_dir`. Cargo marks it with a `CACHEDIR.TAG`; if there is none, this is `out_dir`
/// itself.
pub(crate) fn target_dir(out_dir: &Path) -> PathBuf {
    out_dir.ancestors().find(|dir| dir.join("CACHEDIR.TAG").is_file()).unwrap_or(out_dir).to_path_buf()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hash_keeps_parts_apart() {
        assert_ne!(hash(["ab", "c"]), hash(["a", "bc"]));
        assert_eq!(hash(["a"]), hash(["a"]));
    }

    #[test]
    fn toml_strings_are_escaped() {
        assert_eq!(toml_string(r#"C:\a "b""#), r#""C:\\a \"b\"""#);
        assert_eq!(toml_string("a\nb\u{85}"), "\"a\\u000Ab\\u0085\"");
    }
}
