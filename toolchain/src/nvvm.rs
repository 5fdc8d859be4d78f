//! The second code generator, libNVVM: the crate `optix-nvvm` with the options, the cache folder and the errors of a device
//! build.

use std::path::PathBuf;

pub use optix_nvvm::{
    Dialect, Failure, Library, NoLibrary, PtxVersion, Refusal, Rejected, Translated, Why, libdevice, translate,
};

use crate::cache::cache;
use crate::error::{Doing, Error};
use crate::options::Shaders;

/// Every libNVVM on this machine: [`optix_nvvm::libraries`].
pub fn libraries() -> Vec<PathBuf> {
    optix_nvvm::libraries(cache().as_deref())
}

/// The libNVVM to use: [`optix_nvvm::choose`].
pub fn choose() -> Result<Library, NoLibrary> {
    optix_nvvm::choose(cache().as_deref())
}

/// nvcc's options for libNVVM.
pub(crate) fn options(shaders: &Shaders) -> Vec<String> {
    let switch = |name: &str, on: bool| format!("-{name}={}", u8::from(on));
    let mut options = vec![
        format!("-arch={}", shaders.arch.replacen("sm_", "compute_", 1)),
        switch("ftz", shaders.ftz),
        switch("prec-div", shaders.prec_div),
        switch("prec-sqrt", shaders.prec_sqrt),
        switch("fma", shaders.fmad),
    ];
    options.extend(shaders.line_info.then(|| "-generate-line-info".to_string()));
    options
}

/// The IR of a shader crate as libNVVM takes it.
pub(crate) fn translated(shaders: &Shaders, ir: &str) -> Result<Translated, Error> {
    let dialect = Dialect::of(&shaders.arch)
        .ok_or_else(|| Error::UnknownArch { arch: shaders.arch.clone(), known: vec!["sm_75 and newer".into()] })?;
    translate(ir, dialect).map_err(Error::Refused)
}

/// Compiles a shader crate that was translated.
pub(crate) fn ptx(library: &Library, shaders: &Shaders, module: &Translated) -> Result<String, Error> {
    let libdevice = if module.needs_libdevice {
        let path = libdevice(&library.path).ok_or_else(|| Error::NoLibdevice { library: library.path.clone() })?;
        Some(std::fs::read(&path).doing(|| format!("cannot read {}", path.display()))?)
    } else {
        None
    };
    library.compile(module, libdevice.as_deref(), &options(shaders)).map_err(Error::Nvvm)
}
