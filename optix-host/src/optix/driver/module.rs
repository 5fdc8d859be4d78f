//! Modules: compiled PTX and the built-in intersection programs (guide 6.3, 9.1).

use std::ffi::c_char;
use std::sync::Arc;

use super::accel::AccelOptions;
use super::compile_log::CompileLog;
use super::context::Context;
use super::module_options::{ModuleOptions, RawModuleOptions};
use super::options::PipelineOptions;
use super::sys;
use crate::error::DriverError as Error;

/// Which built-in intersection program (guide 9.1). It must match the build it is used with.
#[derive(Clone, Debug)]
pub struct BuiltinIntersection<'a> {
    /// The kind of primitive: one of the kinds of curves, or spheres.
    pub primitive: sys::OptixPrimitiveType,
    /// Whether the vertices move. This is not about motion transforms.
    pub vertex_motion: bool,
    /// The options that the geometry acceleration structure is built with.
    pub accel: &'a AccelOptions,
    /// Whether curves get end caps.
    pub endcaps: bool,
}

/// A compiled module. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Module(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    raw: sys::OptixModule,
    options: PipelineOptions,
    log: String,
    context: Context,
}

impl Module {
    /// Compiles PTX text. Its `.target` may not be newer than the GPU, its `.version` not newer than the driver knows.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a NUL in the text and for bound values or payload types that break a rule,
    /// [`Error::Optix`] with the compile log otherwise.
    pub fn from_ptx(
        context: &Context,
        ptx: &str,
        options: &ModuleOptions,
        pipeline: &PipelineOptions,
    ) -> Result<Self, Error> {
        check_ptx(ptx)?;
        options.check(pipeline)?;
        let raw_pipeline = pipeline.raw(context)?;
        let raw_options = RawModuleOptions::new(options)?;
        let module_options = raw_options.options();
        let mut log = CompileLog::new();
        let mut raw = sys::OptixModule::NULL;
        let _current = context.enter()?;
        let (log_text, log_size) = log.parts();
        // SAFETY: the context is live, the options and what they point to live until the end of this block, the input is
        // `ptx.len()` bytes, and the log buffer is as long as its size says.
        let result = unsafe {
            let input = ptx.as_ptr().cast::<c_char>();
            let (module_options, pipeline_options) = (&module_options, &raw_pipeline.options);
            let table = context.table();
            table.module_create(
                context.raw(),
                module_options,
                pipeline_options,
                input,
                ptx.len(),
                log_text,
                log_size,
                &mut raw,
            )
        };
        // A module exists even after some failures, and has to be destroyed then.
        let module = Self::own(context, raw, pipeline, log.text());
        context.check_compile("optixModuleCreate", result, &log)?;
        Ok(module)
    }

    /// The driver's intersection program for curves or spheres.
    ///
    /// # Errors
    /// [`Error::Optix`], as for a primitive kind that has no such program.
    pub fn builtin_intersection(
        context: &Context,
        builtin: &BuiltinIntersection<'_>,
        options: &ModuleOptions,
        pipeline: &PipelineOptions,
    ) -> Result<Self, Error> {
        options.check(pipeline)?;
        let raw_pipeline = pipeline.raw(context)?;
        let raw_options = RawModuleOptions::new(options)?;
        let module_options = raw_options.options();
        let builtin_options = sys::OptixBuiltinISOptions {
            builtin_is_module_type: builtin.primitive,
            uses_motion_blur: builtin.vertex_motion.into(),
            build_flags: builtin.accel.flags(),
            curve_endcap_flags: builtin.endcaps.into(),
        };
        let mut raw = sys::OptixModule::NULL;
        let _current = context.enter()?;
        // SAFETY: the context is live; the options and what they point to live until the end of this block.
        let result = unsafe {
            let table = context.table();
            table.builtin_is_module_get(
                context.raw(),
                &module_options,
                &raw_pipeline.options,
                &builtin_options,
                &mut raw,
            )
        };
        let module = Self::own(context, raw, pipeline, String::new());
        context.check("optixBuiltinISModuleGet", result)?;
        Ok(module)
    }

    fn own(context: &Context, raw: sys::OptixModule, pipeline: &PipelineOptions, log: String) -> Self {
        Self(Arc::new(Inner { raw, options: pipeline.clone(), log, context: context.clone() }))
    }

    /// What the compiler wrote: warnings, and at log level 4 its feedback. Empty when the module came from the cache.
    pub fn log(&self) -> &str {
        &self.0.log
    }

    /// The pipeline options it was compiled with.
    pub fn pipeline_options(&self) -> &PipelineOptions {
        &self.0.options
    }

    pub(super) fn raw(&self) -> sys::OptixModule {
        self.0.raw
    }

    pub(super) fn context(&self) -> &Context {
        &self.0.context
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        if self.raw == sys::OptixModule::NULL {
            return;
        }
        if let Ok(_current) = self.context.enter() {
            // SAFETY: made by this context, destroyed here only, and program groups hold the module.
            let _ = unsafe { self.context.table().module_destroy(self.raw) };
        }
    }
}

fn check_ptx(ptx: &str) -> Result<(), Error> {
    const WHAT: &str = "a module from PTX";
    const REMEDY: &str = "pass the text of a .ptx file; OptiX-IR and cubin files are not PTX";
    if ptx.trim().is_empty() {
        return Err(Error::invalid(WHAT, "the text is empty", REMEDY));
    }
    match ptx.bytes().position(|byte| byte == 0) {
        Some(at) => Err(Error::invalid(WHAT, format!("the text has a NUL at byte {at} of {}", ptx.len()), REMEDY)),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ptx_with_a_nul_is_refused_with_its_place() {
        assert!(check_ptx(".version 7.8\0").unwrap_err().to_string().contains("byte 12 of 13"));
        assert!(check_ptx(" \n").is_err());
        assert!(check_ptx(".version 7.8").is_ok());
    }
}
