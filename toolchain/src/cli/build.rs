//! `cargo optix build`

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use optix_toolchain::Workspace;

use super::options::Options;
use super::{Failure, Outcome, current_dir};

pub(super) fn run(arch: &str, options: &Options) -> Outcome {
    let (crates, area) = crates(options.path.as_deref())?;
    crates.iter().try_for_each(|path| build(path, arch, options, &area))?;
    Ok(ExitCode::SUCCESS)
}

/// The shader crate in `path`, or all of the workspace, and the folder for intermediate files.
pub(super) fn crates(path: Option<&Path>) -> Result<(Vec<PathBuf>, PathBuf), Failure> {
    let workspace = match path {
        Some(path) => Workspace::of(path)?,
        None => Workspace::of(&current_dir()?)?,
    };
    let crates: Vec<PathBuf> = match path {
        Some(path) => vec![path.to_path_buf()],
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

fn build(path: &Path, arch: &str, options: &Options, area: &Path) -> Result<(), Failure> {
    let built = options.shaders(path, arch).quiet(false).compile_in(area)?;
    let folder = area.join("ptx");
    let ptx = folder.join(format!("{}.ptx", built.name));
    std::fs::create_dir_all(&folder)
        .and_then(|()| std::fs::write(&ptx, &built.text))
        .map_err(|e| Failure(format!("cannot write {}: {e}", ptx.display())))?;

    for one in optix_toolchain::ptx::suspicious(&built.text) {
        eprintln!("warning: in {}, {one}", one.function);
    }
    say!("{}: {} bytes, {arch}", ptx.display(), built.text.len());
    for entry in &built.entries {
        say!("    {entry}");
    }
    for function in &built.functions {
        say!("    {function} (a function that is called, not inlined)");
    }
    Ok(())
}
