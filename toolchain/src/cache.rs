//! The user's cache folder, for what serves every project.

use std::path::PathBuf;

/// `$XDG_CACHE_HOME/cargo-optix`, or else `~/.cache/cargo-optix`. It holds `core` for the device, and what `cargo optix
/// setup --nvvm` installs. `None` if the user has no home folder.
pub fn cache() -> Option<PathBuf> {
    let variable = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let cache = variable("XDG_CACHE_HOME").or_else(|| Some(variable("HOME")?.join(".cache")));
    Some(cache?.join("cargo-optix"))
}
