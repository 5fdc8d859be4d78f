//! How shader crates are compiled: the options that several commands have.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::ArgAction::Set;
use optix_toolchain::{Codegen, Package, Shaders, Workspace};

use super::{Failure, current_dir};

/// Which crates, and how.
#[derive(clap::Args)]
pub(super) struct Options {
    /// The folder of one shader crate.
    #[arg(long = "crate", value_name = "PATH")]
    pub path: Option<PathBuf>,
    /// What makes the PTX.
    #[arg(long, value_enum, default_value_t = Generator::Rustc)]
    codegen: Generator,
    /// Whether `a * b + c` may become one `fma`.
    #[arg(long, value_name = "BOOL", default_value_t = true, action = Set)]
    fmad: bool,
    /// Whether `f32` instructions take and give zero for subnormal numbers.
    #[arg(long, value_name = "BOOL", default_value_t = false, action = Set, num_args = 0..=1, default_missing_value = "true")]
    ftz: bool,
    /// Whether `f32` division is correctly rounded.
    #[arg(long, value_name = "BOOL", default_value_t = true, action = Set)]
    prec_div: bool,
    /// Whether the `f32` square root is correctly rounded.
    #[arg(long, value_name = "BOOL", default_value_t = true, action = Set)]
    prec_sqrt: bool,
    /// Take functions such as `sin` and `pow` from NVIDIA's libdevice, with CUDA's results to the bit, instead of the
    /// project's own. With `--codegen nvvm`.
    #[arg(long)]
    libdevice: bool,
    /// Keep line information, which changes no instruction: nvcc's `-lineinfo`.
    #[arg(long)]
    debug: bool,
    /// Let arithmetic that overflows and a `debug_assert!` that fails end the program, as the profile `dev` does.
    #[arg(long)]
    checks: bool,
    /// Features to switch on, by commas or spaces: each in all of these shader crates that have it, `CRATE/FEATURE` in one.
    #[arg(long, short = 'F', value_name = "FEATURES", value_delimiter = ',')]
    features: Vec<String>,
    /// Leave out the default features of the shader crates.
    #[arg(long)]
    no_default_features: bool,
    /// The profile of the workspace that says whether overflow and `debug_assert!` are checked; PTX is optimised in any case.
    #[arg(long, value_name = "NAME", default_value = "release")]
    profile: String,
    /// Fail where Cargo.lock is missing or would have to change.
    #[arg(long)]
    locked: bool,
    /// Have no cargo use the network.
    #[arg(long)]
    offline: bool,
    /// A setting for every cargo, or a file of such, as cargo's own. May be repeated.
    #[arg(long, value_name = "KEY=VALUE|PATH")]
    config: Vec<String>,
}

/// A shader crate that was asked for.
pub(super) struct Crate {
    /// Its folder.
    pub path: PathBuf,
    /// The chosen features that this crate has.
    features: Vec<String>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Generator {
    /// rustc's own back end.
    Rustc,
    /// NVIDIA's libNVVM: `cargo optix setup --nvvm` installs it.
    Nvvm,
    /// `rustc_codegen_nvvm` of the Rust-CUDA project, where you have it: `cargo optix doctor` says.
    #[value(name = "rustc_codegen_nvvm")]
    RustCuda,
}

impl Options {
    /// The crates, and the folder for intermediate files: the shader crate that is named, or all of the workspace.
    pub fn crates(&self) -> Result<(Vec<Crate>, PathBuf), Failure> {
        let options: Vec<OsString> = self.cargo_options().into_iter().map(Into::into).collect();
        let workspace = match &self.path {
            Some(path) => Workspace::with_options(path, &options)?,
            None => Workspace::with_options(&current_dir()?, &options)?,
        };
        let real = |path: &Path| std::fs::canonicalize(path).ok();
        let is_chosen = |package: &&Package| match &self.path {
            Some(path) => real(path).is_some() && real(path) == real(package.dir()),
            None => package.has_shaders,
        };
        let packages: Vec<&Package> = workspace.packages.iter().filter(is_chosen).collect();
        let crate_of = |package: &&Package| Crate { path: package.dir().to_path_buf(), features: Vec::new() };
        let mut crates: Vec<Crate> = packages.iter().map(crate_of).collect();
        let area = workspace.target_dir.join("optix");
        if let Some(path) = &self.path {
            let Some(one) = crates.first_mut() else {
                // If this folder is no shader crate, the build will say why.
                return Ok((vec![Crate { path: path.clone(), features: Vec::new() }], area));
            };
            // The path is shown as the user wrote it.
            one.path.clone_from(path);
        } else if crates.is_empty() {
            return Err(Failure(format!(
                "no shader crate in the workspace {}; mark one by `[package.metadata.optix] shaders = true` in its \
                 Cargo.toml, or name one by --crate PATH",
                workspace.root.display()
            )));
        }
        for chosen in self.features.iter().flat_map(|list| list.split_whitespace()) {
            let (of, feature) = chosen.split_once('/').map_or((None, chosen), |(of, feature)| (Some(of), feature));
            let has = |package: &Package| {
                of.is_none_or(|of| package.name == of) && package.features.iter().any(|name| name == feature)
            };
            let mut with = packages.iter().zip(&mut crates).filter(|(package, _)| has(package)).peekable();
            if with.peek().is_none() {
                return Err(Failure(format!("no shader crate here has a feature `{chosen}`")));
            }
            with.for_each(|(_, one)| one.features.push(feature.to_string()));
        }
        Ok((crates, area))
    }

    /// The options that every cargo gets.
    fn cargo_options(&self) -> Vec<String> {
        let offline = self.offline.then(|| "--offline".to_string());
        offline.into_iter().chain(self.config.iter().map(|value| format!("--config={value}"))).collect()
    }

    /// A crate with these options.
    pub fn shaders(&self, one: &Crate, arch: &str) -> Shaders {
        let Self { codegen, fmad, ftz, prec_div, prec_sqrt, libdevice, debug, checks, .. } = *self;
        let codegen = match codegen {
            Generator::Rustc => Codegen::Rustc,
            Generator::Nvvm => Codegen::Nvvm,
            Generator::RustCuda => Codegen::RustCuda,
        };
        let shaders = Shaders::new(&one.path).arch(arch).codegen(codegen).line_info(debug);
        let shaders = if checks { shaders.checks(true) } else { shaders };
        let shaders = shaders.features(&one.features).default_features(!self.no_default_features);
        let shaders = shaders.profile(&self.profile).locked(self.locked).cargo_options(self.cargo_options());
        shaders.fmad(fmad).ftz(ftz).prec_div(prec_div).prec_sqrt(prec_sqrt).libdevice(libdevice)
    }
}
