//! From a shader crate to a checked PTX file.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::blame::{self, Culprit, Missing};
use crate::cargo;
use crate::compiler::{DeviceCompiler, TARGET};
use crate::dep_info;
use crate::error::{Doing, Error};
use crate::libm::{PatchedLibm, SOFTWARE};
use crate::lock;
use crate::messages;
use crate::metadata::{Package, Workspace};
#[cfg(feature = "nvvm")]
use crate::nvvm;
use crate::options::{Codegen, Shaders};
use crate::ptx;
use crate::rust_cuda::{self, Backend};
use crate::sysroot::Sysroot;
use crate::util;
use crate::wrapper::{BUILD_OVERRIDE, PROFILE, Wrapper};

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
    Session::open(shaders, area)?.build()
}

/// A device build of one crate: while it lasts, no other process works in the crate's folder.
pub(crate) struct Session<'a> {
    pub shaders: &'a Shaders,
    pub package: Package,
    pub compiler: DeviceCompiler,
    /// Every package that the shader crate is made from.
    pub graph: Workspace,
    /// The folder of this crate with these options.
    pub own: PathBuf,
    area: PathBuf,
    /// The lock file of the user's workspace, where there is one.
    user_lock: PathBuf,
    resolve: Wrapper,
    sysroot: Sysroot,
    /// Where `rustc` loads its code generator from.
    backend: Option<Backend>,
    _lock: File,
}

impl<'a> Session<'a> {
    /// Finds compiler and packages.
    pub fn open(shaders: &'a Shaders, area: &Path) -> Result<Self, Error> {
        if shaders.libdevice && !shaders.codegen.links_libdevice() {
            return Err(Error::Libdevice);
        }
        let (package, workspace) = shader_crate(&shaders.path)?;
        let backend = if shaders.codegen == Codegen::RustCuda { Some(Backend::find()?) } else { None };
        let compiler = backend.as_ref().map_or_else(DeviceCompiler::find, |backend| Ok(backend.compiler.clone()))?;
        if !compiler.archs.contains(&shaders.arch) {
            return Err(Error::UnknownArch { arch: shaders.arch.clone(), known: compiler.archs });
        }
        util::create_dir(area)?;
        // Cargo runs in other folders.
        let area = std::fs::canonicalize(area).doing(|| format!("cannot find {}", area.display()))?;
        let own = area.join("crates").join(format!("{}-{}", package.name, shaders.key(package.dir())));
        let lock = util::lock(&own.join("lock"))?;

        // The dependency graph, with the versions that the user has locked.
        let user_lock = workspace.root.join("Cargo.lock");
        let resolve = Wrapper::write(own.join("resolve"), shaders, &package, None)?;
        lock::seed(&resolve.dir, &std::fs::read_to_string(&user_lock).unwrap_or_default())?;
        let graph = Workspace::with_dependencies(&resolve.dir)?;
        let generator = backend.as_ref().map(|backend| backend.flags(shaders));
        let sysroot = Sysroot::new(&compiler, &shaders.arch, generator, &area, shaders.quiet);
        Ok(Self { shaders, package, compiler, graph, own, area, user_lock, resolve, sysroot, backend, _lock: lock })
    }

    /// The lock file of the dependency graph.
    pub fn locked(&self) -> Result<String, Error> {
        util::read(&self.resolve.dir.join("Cargo.lock"))
    }

    fn rustflags(&self) -> String {
        let mut flags = vec![
            format!("--sysroot={}", self.sysroot.path.display()),
            // What device code needs from the compiler beyond stable Rust is given from outside, so that a shader
            // crate needs no `#![feature]` and compiles on the host with a stable compiler.
            "-Zcrate-attr=feature(abi_ptx,asm_experimental_arch)".into(),
            "-Aunused_features".into(),
        ];
        match &self.backend {
            None => flags.extend(self.shaders.rustflags()),
            Some(backend) => {
                flags.extend(rust_cuda::ENTRY_ATTRIBUTES.map(|attribute| format!("-Zcrate-attr={attribute}")));
                flags.extend(backend.flags(self.shaders));
            }
        }
        flags.join("\x1f")
    }

    /// Where cargo builds: shared by the crates of one area that are compiled alike.
    pub fn target_dir(&self) -> PathBuf {
        self.area.join(format!("build-{}", util::hash([self.compiler.version.as_str(), &self.rustflags()])))
    }

    /// Compiles the crate and checks that OptiX could load it.
    pub fn build(&self) -> Result<Built, Error> {
        self.compile().map_err(|error| {
            let missing = match &error {
                Error::Ptx { problem: ptx::Problem::Unresolved(names), .. } => {
                    names.iter().map(|name| Missing::of_symbol(name)).collect()
                }
                Error::Ptx { problem: ptx::Problem::Pointers(_), .. } => vec![Missing::Pointers],
                Error::Ptx { problem: ptx::Problem::Recursion(_), .. } => vec![Missing::Recursion],
                Error::Aborted { .. } => vec![Missing::WideConversion],
                _ => return error,
            };
            self.culprit(&missing).map_or(error, |culprit| Error::Missing(Box::new(culprit)))
        })
    }

    /// Who uses what is missing; found by compiling again with line information.
    fn culprit(&self, missing: &[Missing]) -> Option<Culprit> {
        let shaders = self.shaders.clone().line_info(true).codegen(Codegen::Rustc).quiet(true);
        let session;
        let session = if self.shaders.key(self.package.dir()) == shaders.key(self.package.dir()) {
            self
        } else {
            session = Session::open(&shaders, &self.area).ok()?;
            &session
        };
        let wrapper = session.wrapper().ok()?;
        let ir = session.own.join("blame.ll");
        let mut cargo = session.cargo("rustc", &wrapper, &session.target_dir());
        cargo.args(["--lib", "--"]).arg(format!("--emit=llvm-ir={}", ir.display()));
        // It may fail in the same way, but after the IR.
        let _ = cargo.stdout(Stdio::null()).stderr(Stdio::null()).status();
        blame::culprit(&util::read(&ir).ok()?, missing, &session.graph.packages, &session.package)
    }

    fn compile(&self) -> Result<Built, Error> {
        let wrapper = self.wrapper()?;
        let target_dir = self.target_dir();
        self.make_sysroot(&wrapper, &target_dir)?;
        let (text, written) = match self.shaders.codegen {
            Codegen::Rustc => self.generate(&wrapper, &target_dir)?,
            Codegen::RustCuda => self.generate_by_rust_cuda(&wrapper, &target_dir)?,
            #[cfg(feature = "nvvm")]
            Codegen::Nvvm => self.generate_by_nvvm(&wrapper, &target_dir)?,
        };
        let text = ptx::builtins::defined(text);
        let plain = optix_ptx::plain(&text);
        let module = optix_ptx::Module::read(&plain);
        ptx::check(&module).map_err(|problem| Error::Ptx { path: written.clone(), problem })?;
        let names = |entries: bool| {
            let functions = module.defined().filter(|function| function.is_entry == entries);
            functions.map(|function| function.name.to_string()).collect()
        };
        let mut inputs = sources(&target_dir, &wrapper)?;
        let local = self.graph.packages.iter().filter(|package| package.source.is_none());
        inputs.extend(local.map(|package| package.manifest.clone()));
        inputs.retain(|file| !file.starts_with(&self.area));
        inputs.extend(Some(self.user_lock.clone()).filter(|file| file.is_file()));
        inputs.extend(Some(self.compiler.rustc.clone()).filter(|file| file.is_absolute()));
        Ok(Built {
            name: self.package.library.clone().unwrap_or_else(|| self.package.name.clone()),
            entries: names(true),
            functions: names(false),
            ptx: written,
            text,
            inputs,
        })
    }

    /// The package that is compiled: that of the graph, but with another libm.
    fn wrapper(&self) -> Result<Wrapper, Error> {
        let libm = PatchedLibm::write(&self.area, &self.graph.packages)?;
        let wrapper = Wrapper::write(self.own.join("wrapper"), self.shaders, &self.package, libm.as_ref())?;
        let mut locked = self.locked()?;
        if let Some(libm) = &libm {
            locked = lock::with_patched_libm(&locked, &libm.version, SOFTWARE);
        }
        lock::seed(&wrapper.dir, &locked)?;
        Ok(wrapper)
    }

    /// The PTX of rustc's own code generator, and where it is.
    fn generate(&self, wrapper: &Wrapper, target_dir: &Path) -> Result<(String, PathBuf), Error> {
        let mut ptx = self.own.join(format!("{}.ptx", wrapper.library));
        self.run_cargo(wrapper, target_dir, "asm", &ptx)?;
        let mut text = util::read(&ptx)?;
        if self.shaders.ftz {
            text = ptx::ftz::flushed(&text);
            ptx.set_extension("ftz.ptx");
            util::write_if_changed(&ptx, &text)?;
        }
        Ok((text, ptx))
    }

    /// The PTX of `rustc_codegen_nvvm`, which writes it where a linker would write a library, and where it is.
    fn generate_by_rust_cuda(&self, wrapper: &Wrapper, target_dir: &Path) -> Result<(String, PathBuf), Error> {
        let ptx = self.own.join(format!("{}.rust-cuda.ptx", wrapper.library));
        self.run_cargo(wrapper, target_dir, "link", &ptx)?;
        Ok((util::read(&ptx)?, ptx))
    }

    /// The PTX that libNVVM makes of rustc's LLVM IR, and where it is.
    #[cfg(feature = "nvvm")]
    fn generate_by_nvvm(&self, wrapper: &Wrapper, target_dir: &Path) -> Result<(String, PathBuf), Error> {
        let library = nvvm::choose().map_err(Error::NoNvvm)?;
        let ir = self.own.join(format!("{}.ll", wrapper.library));
        self.run_cargo(wrapper, target_dir, "llvm-ir", &ir)?;
        let module = nvvm::translated(self.shaders, &util::read(&ir)?)?;
        // The PTX stays as long as what it was made of does.
        let options = nvvm::options(self.shaders).join(" ");
        let library_path = library.path.to_string_lossy();
        let key = util::hash([module.text.as_str(), &options, &library_path]);
        let ptx = self.own.join(format!("{}.nvvm.ptx", wrapper.library));
        let made_of = ptx.with_extension("key");
        let made = if util::read(&made_of).is_ok_and(|old| old == key) { util::read(&ptx).ok() } else { None };
        let text = match made {
            Some(text) => text,
            None => {
                let text = nvvm::ptx(&library, self.shaders, &module)?;
                util::write_if_changed(&ptx, &text)?;
                util::write_if_changed(&made_of, &key)?;
                text
            }
        };
        Ok((text, ptx))
    }

    /// Compiles the device's library crates, those that are not there. Proc macros need none of them, so cargo gets on
    /// with these in the meantime.
    fn make_sysroot(&self, wrapper: &Wrapper, target_dir: &Path) -> Result<(), Error> {
        if !self.sysroot.is_made() {
            let macros = self.graph.packages.iter().filter(|package| package.is_macro);
            let macros: Vec<_> = macros
                .flat_map(|package| {
                    let id = format!("{}@{}", package.name, package.version);
                    // Asked for by name, they would be optimised.
                    let setting = |set| format!("--config=profile.{PROFILE}.package.{id:?}.{set}");
                    std::iter::once(format!("--package={id}")).chain(BUILD_OVERRIDE.map(setting))
                })
                .collect();
            std::thread::scope(|scope| {
                let core = scope.spawn(|| self.sysroot.make());
                if !macros.is_empty() {
                    // If it fails, it will fail again.
                    let _ = cargo::run(self.cargo("build", wrapper, target_dir).args(macros), "compiling proc macros");
                }
                core.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            })?;
        }
        let uses_alloc =
            || self.graph.ways(&self.package).iter().filter_map(|way| way.last()).any(|p| p.may_use_alloc());
        if !self.sysroot.has_alloc() && uses_alloc() { self.sysroot.make_alloc() } else { Ok(()) }
    }

    /// Has rustc emit `what` of the wrapper package to the file `to`.
    fn run_cargo(&self, wrapper: &Wrapper, target_dir: &Path, what: &str, to: &Path) -> Result<(), Error> {
        let run = || {
            let mut command = self.cargo("rustc", wrapper, target_dir);
            let emit = format!("--emit={what}={}", to.display());
            let doing = format!("compiling {} for the device", self.package.name);
            command.args(["--lib", messages::format(), "--", &emit]);
            messages::run(&mut command, &doing, &self.graph, &self.package)
        };
        run()?;
        if !to.is_file() {
            // Somebody removed it. Cargo does not know of the file, but it does look at the source's time.
            let source = wrapper.dir.join("src/lib.rs");
            let text = util::read(&source)?;
            std::fs::write(&source, text).doing(|| format!("cannot write {}", source.display()))?;
            run()?;
        }
        Ok(())
    }

    /// `cargo build` or `cargo rustc` of the wrapper package.
    fn cargo(&self, subcommand: &str, wrapper: &Wrapper, target_dir: &Path) -> Command {
        let mut command = cargo::command(&wrapper.dir);
        command
            .args([subcommand, "--profile", PROFILE, "--target", TARGET])
            .args(self.shaders.quiet.then_some("--quiet"))
            .arg("--target-dir")
            .arg(target_dir)
            .env("RUSTC", &self.compiler.rustc)
            .env("RUSTC_BOOTSTRAP", "1")
            // Also where a configuration file names a wrapper.
            .env("RUSTC_WRAPPER", "")
            .env("RUSTC_WORKSPACE_WRAPPER", "")
            .env("CARGO_ENCODED_RUSTFLAGS", self.rustflags());
        if self.backend.is_some() {
            rust_cuda::prepare(&mut command);
        }
        command
    }
}

/// The sources that cargo found the PTX to depend on, those of path dependencies included.
fn sources(target_dir: &Path, wrapper: &Wrapper) -> Result<Vec<PathBuf>, Error> {
    let dep_info = target_dir.join(TARGET).join(PROFILE).join(format!("lib{}.d", wrapper.library));
    Ok(dep_info::sources(&util::read(&dep_info)?))
}
