//! `cargo optix build`

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use optix_toolchain::{Shaders, Workspace};

use super::{Failure, Outcome, current_dir};

pub(super) fn run(arch: &str, path: Option<PathBuf>) -> Outcome {
    let (crates, area) = crates(path)?;
    crates.iter().try_for_each(|path| build(path, arch, &area))?;
    Ok(ExitCode::SUCCESS)
}

/// The shader crate in `path`, or all of the workspace, and the folder for intermediate files.
pub(super) fn crates(path: Option<PathBuf>) -> Result<(Vec<PathBuf>, PathBuf), Failure> {
    let workspace = match &path {
        Some(path) => Workspace::of(path)?,
        None => Workspace::of(&current_dir()?)?,
    };
    let crates: Vec<PathBuf> = match path {
        Some(path) => vec![path],
        None => workspace.packages.iter().filter(|p| p.has_shaders).map(|p| p.dir().to_path_buf()).collect(),
    };
    if crates.is_empty() {
        return Err(Failure(format!(
            "no shader crate in the workspace {}; mark one by `[package.metadata.optix] shaders = true` in its \
             Cargo.toml, or name one by --crate PATH",
            workspace.root.display()
        )));
    }
    Ok((crates, workspace.target_dir.join("optix")))
}

fn build(path: &Path, arch: &str, area: &Path) -> Result<(), Failure> {
    let built = Shaders::new(path).arch(arch).quiet(false).compile_in(area)?;
    let folder = area.join("ptx");
    let ptx = folder.join(format!("{}.ptx", built.name));
    std::fs::create_dir_all(&folder)
        .and_then(|()| std::fs::write(&ptx, &built.text))
        .map_err(|e| Failure(format!("cannot write {}: {e}", ptx.display())))?;

    say!("{}: {} bytes, {arch}", ptx.display(), built.text.len());
    for entry in &built.entries {
        say!("    {entry}");
    }
    for function in &built.functions {
        say!("    {function} (a function that is called, not inlined)");
    }
    Ok(())
}
