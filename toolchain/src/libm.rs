//! A `libm` for the device.
//!
//! `no_std` crates such as glam call the `libm` crate, whose `sqrtf` is some 80 integer instructions. The device
//! build replaces that crate by one of the same version which compiles `sqrt`, `floor`, `fma` and the like to the
//! machine's instructions, computes the elementary functions of `f32` in `f32`, and takes every other function from the
//! original.

use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::metadata::Package;
use crate::util::{self, toml_string, write_if_changed};

/// The name of the original package in the device build. It needs one of its own, because a lock file can't tell apart
/// two packages called `libm` with the same version.
pub(crate) const SOFTWARE: &str = "optix-libm-software";

/// Functions of the replacement that are called instead of inlined, because they are long and rarely needed.
#[cfg(feature = "cli")]
pub(crate) const OUT_OF_LINE: [&str; 1] = ["libm::sin_cos::reduce_large"];

const SOURCES: [(&str, &str); 8] = [
    ("src/lib.rs", include_str!("../templates/libm/lib.rs")),
    ("src/exp.rs", include_str!("../templates/libm/exp.rs")),
    ("src/hyperbolic.rs", include_str!("../templates/libm/hyperbolic.rs")),
    ("src/inverse.rs", include_str!("../templates/libm/inverse.rs")),
    ("src/libdevice.rs", include_str!("../templates/libm/libdevice.rs")),
    ("src/log.rs", include_str!("../templates/libm/log.rs")),
    ("src/root.rs", include_str!("../templates/libm/root.rs")),
    ("src/sin_cos.rs", include_str!("../templates/libm/sin_cos.rs")),
];

/// The replacement on disk.
pub(crate) struct PatchedLibm {
    /// Its folder.
    pub dir: PathBuf,
    /// Its version, which is the original's.
    pub version: String,
}

impl PatchedLibm {
    /// Writes the replacement for the `libm` 0.2 among `packages` under `area`. `None`: nothing uses that.
    pub fn write(area: &Path, packages: &[Package]) -> Result<Option<Self>, Error> {
        let is_libm = |package: &&Package| {
            let registry = package.source.as_deref().is_some_and(|source| source.starts_with("registry+"));
            package.name == "libm" && package.version.starts_with("0.2.") && registry
        };
        let Some(original) = packages.iter().find(is_libm) else {
            return Ok(None);
        };
        let name = format!("libm-{}", original.version);
        let _lock = util::lock(&area.join(format!("{name}.lock")))?;
        let dir = area.join(name);
        copy_original(original, &dir.join("software"))?;
        write_if_changed(&dir.join("Cargo.toml"), &manifest(original))?;
        for (file, text) in SOURCES {
            write_if_changed(&dir.join(file), text)?;
        }
        Ok(Some(Self { dir, version: original.version.clone() }))
    }
}

/// Copies the package under its new name. It is a copy because the package's build script expects to stand beside its
/// manifest.
fn copy_original(original: &Package, to: &Path) -> Result<(), Error> {
    let manifest = util::read(&original.manifest)?;
    let renamed = manifest.replacen("\nname = \"libm\"", &format!("\nname = \"{SOFTWARE}\""), 1);
    // The manifest is written last, so the copy is complete if there is one.
    if std::fs::read_to_string(to.join("Cargo.toml")).is_ok_and(|there| there == renamed) {
        return Ok(());
    }
    for part in ["src", "build.rs", "configure.rs"] {
        let source = original.dir().join(part);
        if source.is_dir() {
            util::copy_dir(&source, &to.join(part))?;
        } else if source.is_file() {
            write_if_changed(&to.join(part), &util::read(&source)?)?;
        }
    }
    // Warnings in this package are for its authors. Cargo silences them only in packages from a registry.
    let root = to.join("src/lib.rs");
    write_if_changed(&root, &format!("#![allow(warnings)]\n{}", util::read(&root)?))?;
    write_if_changed(&to.join("Cargo.toml"), &renamed)?;
    Ok(())
}

fn manifest(original: &Package) -> String {
    let mut text = format!(
        "# Written by optix-toolchain; see its `libm` module.\n\
         [package]\n\
         name = \"libm\"\n\
         version = \"{}\"\n\
         edition = \"2024\"\n\
         publish = false\n\n\
         [dependencies.software]\n\
         package = \"{SOFTWARE}\"\n\
         path = \"software\"\n\
         default-features = false\n\n\
         [features]\n",
        original.version
    );
    for feature in original.features.iter().filter(|feature| *feature != "default") {
        text.push_str(&format!("{feature} = [{}]\n", toml_string(&format!("software/{feature}"))));
    }
    if original.features.iter().any(|feature| feature == "default") {
        text.push_str("default = [\"software/default\"]\n");
    }
    text
}
