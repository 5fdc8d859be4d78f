//! From a shader crate to a checked PTX file.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::cargo::{self, Place};
use crate::compiler::{DeviceCompiler, TARGET};
use crate::dep_info;
use crate::error::{Doing, Error};
use crate::libm::{PatchedLibm, SOFTWARE};
use crate::lock;
use crate::messages;
use crate::metadata::{Package, Workspace};
use crate::missing::{Culprit, Missing, culprit};
#[cfg(feature = "nvvm")]
use crate::nvvm;
use crate::options::{Codegen, Shaders};
use crate::original::Original;
use crate::outer;
use crate::ptx;
use crate::rust_cuda::{self, Backend};
use crate::sysroot::Sysroot;
use crate::units::{self, Checks, Unit};
use crate::util;
use crate::wrapper::{BUILD_OVERRIDE, PROFILE, Recipe, Wrapper};

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

pub(crate) fn build(shaders: &Shaders, area: &Path) -> Result<Built, Error> {
    Session::open(shaders, area)?.build()
}

/// A device build of one crate. While the value lives, no other process works in the crate's folder.
pub(crate) struct Session<'a> {
    pub shaders: &'a Shaders,
    pub package: Package,
    pub compiler: DeviceCompiler,
    /// Every package that the shader crate is made from.
    pub graph: Workspace,
    /// The folder for this crate with these options.
    pub own: PathBuf,
    /// Where cargo runs.
    pub place: Place,
    /// What the generated packages are written from.
    pub recipe: Recipe,
    area: PathBuf,
    key: String,
    /// The user's manifests and configuration files, which the build depends on.
    settings: Vec<PathBuf>,
    resolve: Wrapper,
    sysroot: Sysroot,
    /// Where `rustc` loads its code generator from.
    backend: Option<Backend>,
    _lock: File,
}

impl<'a> Session<'a> {
    /// Finds the compiler and the packages, and prepares the folders.
    pub fn open(shaders: &'a Shaders, area: &Path) -> Result<Self, Error> {
        if shaders.libdevice && !shaders.codegen.links_libdevice() {
            return Err(Error::Libdevice);
        }
        let original = Original::find(shaders)?;
        let package = original.shaders.clone();
        let backend = if shaders.codegen == Codegen::RustCuda { Some(Backend::find()?) } else { None };
        let compiler = backend.as_ref().map_or_else(DeviceCompiler::find, |backend| Ok(backend.compiler.clone()))?;
        if !compiler.archs.contains(&shaders.arch) {
            return Err(Error::UnknownArch { arch: shaders.arch.clone(), known: compiler.archs });
        }
        util::create_dir(area)?;
        // Cargo runs in other folders, so paths are absolute.
        let area = std::fs::canonicalize(area).doing(|| format!("cannot find {}", area.display()))?;
        let of_host = match &shaders.outer {
            Some(outer) => original.units_of_host(outer, &compiler, &area)?,
            None => Vec::new(),
        };
        let features = original.features(shaders, &of_host)?;
        let key = shaders.key(package.dir(), &original.workspace.root, &features);
        let own = area.join("crates").join(format!("{}-{key}", package.name));
        let lock = util::lock(&own.join("lock"))?;

        let generator = backend.as_ref().map(|backend| backend.flags(shaders));
        let sysroot = Sysroot::new(&compiler, &shaders.arch, generator, &area, shaders.quiet);
        let recipe = Recipe {
            features,
            patches: original.patches(),
            resolver: RESOLVERS[0],
            checks: Checks::all(shaders.checks.unwrap_or(false)),
            other_checks: Vec::new(),
        };
        // `agree` finds its dependency graph.
        let graph = Workspace { packages: Vec::new(), members: Vec::new(), ..original.workspace.clone() };
        let resolve = Wrapper::write(own.join("resolve"), shaders, &package, &recipe, &key, None)?;
        lock::seed(&resolve.dir, &std::fs::read_to_string(original.lock()).unwrap_or_default())?;
        let (place, settings) = (original.place.clone(), original.settings());
        let mut session = Self {
            shaders,
            package,
            compiler,
            graph,
            own,
            place,
            recipe,
            area,
            key,
            settings,
            resolve,
            sysroot,
            backend,
            _lock: lock,
        };
        session.agree(&original, &of_host)?;
        Ok(session)
    }

    /// Resolves the generated package with the versions that the user has locked. Makes sure that the device build is
    /// made from the same packages and features as the user's own build, and takes over its run-time checks.
    fn agree(&mut self, original: &Original, of_host: &[Unit]) -> Result<(), Error> {
        self.graph = Workspace::with_dependencies(&self.place, &self.resolve.manifest(), &[])?;
        let mut differences = original.differences(&self.graph);
        if !differences.is_empty() {
            return Err(Error::Differs { package: self.package.name.clone(), differences });
        }
        let doing = format!("finding out how {} is compiled", self.package.name);
        let target_dir = self.target_dir();
        let mut theirs = of_host.to_vec();
        if original.is_member {
            let features: Vec<&str> = self.recipe.features.iter().map(String::as_str).collect();
            let profile = self.shaders.profile_name();
            let mut command = original.build(&self.package, profile, &features, &target_dir);
            theirs = units::units(self.for_device(&mut command).arg("--lib"), &doing)?;
            for resolver in RESOLVERS {
                self.recipe.resolver = resolver;
                self.resolve = Wrapper::write(
                    self.own.join("resolve"),
                    self.shaders,
                    &self.package,
                    &self.recipe,
                    &self.key,
                    None,
                )?;
                let mut command = self.cargo("build", &self.resolve, &target_dir);
                let ours = units::units(command.arg("--lib"), &doing)?;
                differences = original.feature_differences(&theirs, &self.graph, &ours);
                if differences.is_empty() {
                    break;
                }
            }
            if !differences.is_empty() {
                return Err(Error::Differs { package: self.package.name.clone(), differences });
            }
        }
        if self.shaders.checks.is_none() {
            let target = original.is_member.then_some(TARGET);
            (self.recipe.checks, self.recipe.other_checks) = original.checks(&theirs, target, &self.graph);
        }
        Ok(())
    }

    /// The lock file of the dependency graph.
    pub fn locked(&self) -> Result<String, Error> {
        util::read(&self.resolve.dir.join("Cargo.lock"))
    }

    fn rustflags(&self) -> String {
        let mut flags = vec![
            format!("--sysroot={}", self.sysroot.path.display()),
            // Unstable compiler features that device code needs are given on the command line, so that a shader crate
            // needs no `#![feature]` and compiles on the host with a stable compiler.
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
        flags.extend(outer::flags());
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

    /// Finds who uses what is missing, by compiling again with line information.
    fn culprit(&self, missing: &[Missing]) -> Option<Culprit> {
        let shaders = self.shaders.clone().line_info(true).codegen(Codegen::Rustc).quiet(true);
        let session;
        let session = if self.shaders.line_info && self.shaders.codegen == Codegen::Rustc {
            self
        } else {
            session = Session::open(&shaders, &self.area).ok()?;
            &session
        };
        let wrapper = session.wrapper().ok()?;
        let mut cargo = session.cargo("rustc", &wrapper, &session.target_dir());
        cargo.args(["--lib", "--", "--emit=llvm-ir=missing.ll"]);
        let ir = wrapper.dir.join("missing.ll");
        // This may fail as the first build did, but only after the IR has been written.
        let _ = cargo.stdout(Stdio::null()).stderr(Stdio::null()).status();
        culprit(&util::read(&ir).ok()?, missing, &session.graph.packages, &session.package)
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
        inputs.extend(self.settings.iter().cloned());
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
        let dir = self.own.join("wrapper");
        let wrapper = Wrapper::write(dir, self.shaders, &self.package, &self.recipe, &self.key, libm.as_ref())?;
        let mut locked = self.locked()?;
        if let Some(libm) = &libm {
            locked = lock::with_patched_libm(&locked, &libm.version, SOFTWARE);
        }
        lock::seed(&wrapper.dir, &locked)?;
        Ok(wrapper)
    }

    /// The PTX of rustc's own code generator, and its path.
    fn generate(&self, wrapper: &Wrapper, target_dir: &Path) -> Result<(String, PathBuf), Error> {
        let mut ptx = self.emit(wrapper, target_dir, "asm", "ptx")?;
        let mut text = util::read(&ptx)?;
        if self.shaders.ftz {
            text = ptx::ftz::flushed(&text);
            ptx.set_extension("ftz.ptx");
            util::write_if_changed(&ptx, &text)?;
        }
        Ok((text, ptx))
    }

    /// The PTX of `rustc_codegen_nvvm`, and its path. The generator writes it where a linker would write a library.
    fn generate_by_rust_cuda(&self, wrapper: &Wrapper, target_dir: &Path) -> Result<(String, PathBuf), Error> {
        let ptx = self.emit(wrapper, target_dir, "link", "rust-cuda.ptx")?;
        Ok((util::read(&ptx)?, ptx))
    }

    /// The PTX that libNVVM makes of rustc's LLVM IR, and its path.
    #[cfg(feature = "nvvm")]
    fn generate_by_nvvm(&self, wrapper: &Wrapper, target_dir: &Path) -> Result<(String, PathBuf), Error> {
        let library = nvvm::choose().map_err(Error::NoNvvm)?;
        let ir = self.emit(wrapper, target_dir, "llvm-ir", "ll")?;
        let module = nvvm::translated(self.shaders, &util::read(&ir)?)?;
        // Made again only if what it is made of has changed.
        let options = nvvm::options(self.shaders).join(" ");
        let library_path = library.path.to_string_lossy();
        let key = util::hash([module.text.as_str(), &options, &library_path]);
        let ptx = ir.with_extension("nvvm.ptx");
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

    /// Compiles those of the device's library crates that are not there yet. Proc macros do not need them, so cargo
    /// compiles those in the meantime.
    fn make_sysroot(&self, wrapper: &Wrapper, target_dir: &Path) -> Result<(), Error> {
        if !self.sysroot.is_made() {
            let macros = self.graph.packages.iter().filter(|package| package.is_macro);
            let macros: Vec<_> = macros
                .flat_map(|package| {
                    let id = format!("{}@{}", package.name, package.version);
                    // Cargo does not apply its settings for build dependencies to packages that are asked for by name,
                    // so each is given them here.
                    let setting = |set| format!("--config=profile.{PROFILE}.package.{id:?}.{set}");
                    std::iter::once(format!("--package={id}")).chain(BUILD_OVERRIDE.map(setting))
                })
                .collect();
            std::thread::scope(|scope| {
                let core = scope.spawn(|| self.sysroot.make());
                if !macros.is_empty() {
                    // An error here is not reported: the build proper meets it again, and reports it.
                    let _ = cargo::run(self.cargo("build", wrapper, target_dir).args(macros), "compiling proc macros");
                }
                core.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            })?;
        }
        let uses_alloc =
            || self.graph.ways(&self.package).iter().filter_map(|way| way.last()).any(|p| p.may_use_alloc());
        if !self.sysroot.has_alloc() && uses_alloc() { self.sysroot.make_alloc() } else { Ok(()) }
    }

    /// Makes rustc emit `what` of the wrapper package, and returns the path.
    fn emit(&self, wrapper: &Wrapper, target_dir: &Path, what: &str, extension: &str) -> Result<PathBuf, Error> {
        let name = format!("{}.{extension}", wrapper.library);
        let file = wrapper.dir.join(&name);
        let run = || {
            let mut command = self.cargo("rustc", wrapper, target_dir);
            // Relative to the package, where cargo runs rustc: rustc splits the list at commas, which a path may have.
            let emit = format!("--emit={what}={name}");
            let doing = format!("compiling {} for the device", self.package.name);
            command.args(["--lib", messages::format(), "--", &emit]);
            messages::run(&mut command, &doing, &self.graph, &self.package)
        };
        // Cargo does not know of this file: it takes for fresh whatever it has compiled once, though the file may come
        // from something else that was compiled since, or be gone. But it does compare the time of the source.
        let made_of = util::hash([&*util::read(&wrapper.manifest())?, &*util::read(&wrapper.dir.join("Cargo.lock"))?]);
        let stamp = file.with_extension("made-of");
        if !file.is_file() || !util::read(&stamp).is_ok_and(|old| old == made_of) {
            let source = wrapper.dir.join("src/lib.rs");
            let text = util::read(&source)?;
            std::fs::write(&source, text).doing(|| format!("cannot write {}", source.display()))?;
            let _ = std::fs::remove_file(&stamp);
        }
        run()?;
        util::write_if_changed(&stamp, &made_of)?;
        Ok(file)
    }

    /// `cargo build` or `cargo rustc` of the wrapper package.
    fn cargo(&self, subcommand: &str, wrapper: &Wrapper, target_dir: &Path) -> Command {
        let mut command = self.place.cargo(subcommand, &wrapper.manifest());
        command.args(["--profile", PROFILE]).args(self.shaders.quiet.then_some("--quiet"));
        command.arg("--target-dir").arg(target_dir);
        self.for_device(&mut command);
        if self.backend.is_some() {
            rust_cuda::prepare(&mut command);
        }
        command
    }

    /// Makes a cargo compile for the device.
    fn for_device<'c>(&self, command: &'c mut Command) -> &'c mut Command {
        self.by_device_compiler(command).args(["--target", TARGET]).env("CARGO_ENCODED_RUSTFLAGS", self.rustflags())
    }

    /// Makes a cargo use the device compiler.
    pub fn by_device_compiler<'c>(&self, command: &'c mut Command) -> &'c mut Command {
        // The user's own build holds the lock of its build folder meanwhile, so this one needs another.
        self.compiler.used_by(command).env("CARGO_BUILD_BUILD_DIR", self.target_dir())
    }
}

/// The versions of cargo's feature resolver, the usual one first. `cargo metadata` does not say which one a workspace
/// uses.
const RESOLVERS: [&str; 2] = ["3", "1"];

/// The sources that cargo found the PTX to depend on, those of path dependencies included.
fn sources(target_dir: &Path, wrapper: &Wrapper) -> Result<Vec<PathBuf>, Error> {
    let dep_info = target_dir.join(TARGET).join(PROFILE).join(format!("lib{}.d", wrapper.library));
    Ok(dep_info::sources(&util::read(&dep_info)?))
}
