//! `cargo optix build`

use std::path::Path;
use std::process::ExitCode;

use super::options::{Crate, Options};
use super::{Failure, Outcome};

pub(super) fn run(arch: &str, options: &Options) -> Outcome {
    let (crates, area) = options.crates()?;
    crates.iter().try_for_each(|one| build(one, arch, options, &area))?;
    Ok(ExitCode::SUCCESS)
}

fn build(one: &Crate, arch: &str, options: &Options, area: &Path) -> Result<(), Failure> {
    let built = options.shaders(one, arch).quiet(false).compile_in(area)?;
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
