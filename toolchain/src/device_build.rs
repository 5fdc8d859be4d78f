//! From a shader crate to a checked PTX file.

use std::path::{Path, PathBuf};

use crate::cargo;
use crate::compiler::{DeviceCompiler, TARGET};
use crate::dep_info;
use crate::error::{Doing, Error};
use crate::libm::{PatchedLibm, SOFTWARE};
use crate::lock;
use crate::metadata::{Package, Workspace};
use crate::options::Shaders;
use crate::ptx;
use crate::sysroot;
use crate::util;
use crate::wrapper::{PROFILE, Wrapper};

/// A compiled shader crate.
#[derive(Clone, Debug)]
pub struct Built {
    /// The library name of the shader crate: `my_shaders`.
    pub name: String,
    /// The PTX file, in the area of the build.
    pub ptx: PathBuf,
    /// Its text.
    pub text: String,
    /// The entry points in it, as `__raygen__camera`, in the order of the text.
    pub entries: Vec<String>,
    /// The functions in it that are called instead of inlined.
    pub functions: Vec<String>,
    /// Every file the PTX was made from: sources, manifests, the lock file and the compiler.
    pub inputs: Vec<PathBuf>,
}

/// The shader crate in `path`, and the workspace it is in.
pub(crate) fn shader_crate(path: &Path) -> Result<(Package, Workspace), Error> {
    let not = |reason: &str| Error::NotAShaderCrate { path: path.to_path_buf(), reason: reason.to_string() };
    let dir = std::fs::canonicalize(path).map_err(|_| not("there is no such folder"))?;
    if !dir.join("Cargo.toml").is_file() {
        return Err(not("it has no Cargo.toml"));
    }
    let workspace = Workspace::of(&dir)?;
    let package = workspace.packages.iter().find(|package| package.dir() == dir).cloned();
    Ok((package.ok_or_else(|| not("its Cargo.toml is no package"))?, workspace))
}

pub(crate) fn build(shaders: &Shaders, area: &Path) -> Result<Built, Error> {
    let (package, workspace) = shader_crate(&shaders.path)?;
    let compiler = DeviceCompiler::find()?;
    if !compiler.archs.contains(&shaders.arch) {
        return Err(Error::UnknownArch { arch: shaders.arch.clone(), known: compiler.archs });
    }
    util::create_dir(area)?;
    // Cargo runs in other folders.
    let area = std::fs::canonicalize(area).doing(|| format!("cannot find {}", area.display()))?;
    let own = area.join("crates").join(format!("{}-{}", package.name, shaders.key(package.dir())));
    let _lock = util::lock(&own.join("lock"))?;

    // First the dependency graph, with the versions that the user has locked ..
    let user_lock = workspace.root.join("Cargo.lock");
    let resolve = Wrapper::write(own.join("resolve"), shaders, &package, None)?;
    lock::seed(&resolve.dir, &std::fs::read_to_string(&user_lock).unwrap_or_default())?;
    let graph = Workspace::with_dependencies(&resolve.dir)?;
    // .. then the same with another libm.
    let libm = PatchedLibm::write(&area, &graph.packages)?;
    let wrapper = Wrapper::write(own.join("wrapper"), shaders, &package, libm.as_ref())?;
    let mut locked = util::read(&resolve.dir.join("Cargo.lock"))?;
    if let Some(libm) = &libm {
        locked = lock::with_patched_libm(&locked, &libm.version, SOFTWARE);
    }
    lock::seed(&wrapper.dir, &locked)?;

    let sysroot = sysroot::ensure(&compiler, &shaders.arch, &area, shaders.quiet)?;
    let rustflags = shaders.rustflags(&sysroot).join("\x1f");
    let target_dir = area.join(format!("build-{}", util::hash([compiler.version.as_str(), &rustflags])));
    let ptx = own.join(format!("{}.ptx", wrapper.library));
    run_cargo(shaders, &wrapper, &compiler, &rustflags, &target_dir, &ptx, &package)?;

    let text = util::read(&ptx)?;
    let module = ptx::Module::read(&text).map_err(|problem| Error::Ptx { path: ptx.clone(), problem })?;
    let mut inputs = sources(&target_dir, &wrapper)?;
    inputs.extend(graph.packages.iter().filter(|package| package.source.is_none()).map(|p| p.manifest.clone()));
    inputs.retain(|file| !file.starts_with(&area));
    inputs.extend(Some(user_lock).filter(|file| file.is_file()));
    inputs.extend(Some(compiler.rustc).filter(|file| file.is_absolute()));
    Ok(Built {
        name: package.library.unwrap_or(package.name),
        entries: module.entries.iter().map(|name| name.to_string()).collect(),
        functions: module.functions.iter().map(|name| name.to_string()).collect(),
        ptx,
        text,
        inputs,
    })
}

fn run_cargo(
    shaders: &Shaders,
    wrapper: &Wrapper,
    compiler: &DeviceCompiler,
    rustflags: &str,
    target_dir: &Path,
    ptx: &Path,
    package: &Package,
) -> Result<(), Error> {
    let run = || {
        let mut command = cargo::command(&wrapper.dir);
        command
            .args(["rustc", "--lib", "--profile", PROFILE, "--target", TARGET])
            .args(shaders.quiet.then_some("--quiet"))
            .arg("--target-dir")
            .arg(target_dir)
            .arg("--")
            .arg(format!("--emit=asm={}", ptx.display()))
            .env("RUSTC", &compiler.rustc)
            .env("RUSTC_BOOTSTRAP", "1")
            // Also where a configuration file names a wrapper.
            .env("RUSTC_WRAPPER", "")
            .env("RUSTC_WORKSPACE_WRAPPER", "")
            .env("CARGO_ENCODED_RUSTFLAGS", rustflags);
        cargo::run(&mut command, &format!("compiling {} for the device", package.name))
    };
    run()?;
    if !ptx.is_file() {
        // Somebody removed it. Cargo does not know of the file, but it does look at the source's time.
        let source = wrapper.dir.join("src/lib.rs");
        let text = util::read(&source)?;
        std::fs::write(&source, text).doing(|| format!("cannot write {}", source.display()))?;
        run()?;
    }
    Ok(())
}

/// The sources that cargo found the PTX to depend on, those of path dependencies included.
fn sources(target_dir: &Path, wrapper: &Wrapper) -> Result<Vec<PathBuf>, Error> {
    let dep_info = target_dir.join(TARGET).join(PROFILE).join(format!("lib{}.d", wrapper.library));
    Ok(dep_info::sources(&util::read(&dep_info)?))
}
