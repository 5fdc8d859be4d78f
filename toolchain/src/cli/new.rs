//! `cargo optix new`

use std::path::Path;
use std::process::ExitCode;

use optix_toolchain::json::Json;

use super::{Failure, Outcome};

/// The files of a new project; `{{..}}` is replaced.
const FILES: [(&str, &str); 6] = [
    ("Cargo.toml", include_str!("../../templates/new/host.toml")),
    ("build.rs", include_str!("../../templates/new/build.rs")),
    ("src/main.rs", include_str!("../../templates/new/main.rs")),
    ("shaders/Cargo.toml", include_str!("../../templates/new/shaders.toml")),
    ("shaders/src/lib.rs", include_str!("../../templates/new/shaders.rs")),
    (".gitignore", "/target\n"),
];

pub(super) fn run(path: &Path) -> Outcome {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    check_name(name)?;
    if path.exists() {
        return Err(Failure(format!("{} exists already; choose another name", path.display())));
    }
    for (file, template) in FILES {
        let file = path.join(file);
        let folder = file.parent().unwrap_or(path);
        std::fs::create_dir_all(folder)
            .and_then(|()| std::fs::write(&file, fill(template, name, Path::new(env!("CARGO_MANIFEST_DIR")))))
            .map_err(|e| Failure(format!("cannot write {}: {e}", file.display())))?;
    }
    say!("Made {}. To run it: cd {} && cargo run --release", path.display(), path.display());
    Ok(ExitCode::SUCCESS)
}

/// Checks a package name. It has to be an identifier with `-` for `_`, because the shader crate's name becomes part of
/// code.
fn check_name(name: &str) -> Result<(), Failure> {
    // Crates that the project itself uses have these names, or cargo or rustc give them a meaning.
    const TAKEN: [&str; 12] = [
        "test",
        "core",
        "std",
        "alloc",
        "proc_macro",
        "build",
        "deps",
        "examples",
        "incremental",
        "glam",
        "shaders",
        "optix",
    ];
    let refuse = |why: &str| Err(Failure(format!("`{name}` can't name a project: {why}")));
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    let identifier = name.replace('-', "_");
    if !name.starts_with(|c: char| c.is_ascii_alphabetic()) || !name.chars().all(is_part) {
        refuse("it must be ASCII letters, digits, `-` and `_`, and start with a letter")
    } else if TAKEN.contains(&identifier.as_str()) || identifier.starts_with("optix_") {
        refuse("a crate of that name is in use; choose another")
    } else {
        Ok(())
    }
}

/// Fills in a template. `toolchain` is the folder that this command was compiled in. If the toolkit's other crates are
/// beside it, the project uses those, and otherwise the published ones of this command's version.
fn fill(template: &str, name: &str, toolchain: &Path) -> String {
    let checkout = toolchain.parent().filter(|root| root.join("optix-host/Cargo.toml").is_file());
    let dependency = |folder: &str| match checkout {
        Some(root) => format!("path = {}", quoted(&root.join(folder).to_string_lossy())),
        None => format!("version = \"{}\"", env!("CARGO_PKG_VERSION")),
    };
    template
        .replace("{{name}}", name)
        .replace("{{ident}}", &name.replace('-', "_"))
        .replace("{{IDENT}}", &name.replace('-', "_").to_uppercase())
        .replace("{{optix-device-rs}}", &dependency("optix-device-rs"))
        .replace("{{optix-host}}", &dependency("optix-host"))
        .replace("{{optix-toolchain}}", &dependency("toolchain"))
}

/// A TOML string.
fn quoted(text: &str) -> String {
    Json::String(text.to_string()).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_checked() {
        for good in ["demo", "my-tracer", "a1_b"] {
            assert!(check_name(good).is_ok(), "{good}");
        }
        for bad in ["", "1st", "a b", "a/b", "über", "test", "proc-macro", "optix-host", "..", "-x"] {
            assert!(check_name(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn templates_are_filled() {
        for (file, template) in FILES {
            let text = fill(template, "my-tracer", Path::new("/nonexistent/toolchain"));
            assert!(!text.contains("{{"), "{file}");
        }
        let manifest = fill(FILES[0].1, "my-tracer", Path::new("/nonexistent/toolchain"));
        assert!(manifest.contains("version = \"0.1.0\"") && !manifest.contains("path = \"/"));
        assert_eq!(quoted(r#"C:\it's "here""#), r#""C:\\it's \"here\"""#);
    }
}
