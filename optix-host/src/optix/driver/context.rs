//! A device context: one GPU, one stream, one OptiX context, one log (guide 4).

use std::any::Any;
use std::ffi::CString;
use std::path::PathBuf;
use std::sync::Arc;

use cudarc::driver::result::{self, DriverError};
use cudarc::driver::sys as cu;

use super::compile_log::CompileLog;
use super::cuda::{self, Current, DeviceInfo};
use super::library::{self, Api};
use super::limits::Limits;
use super::log::{self, LogLevel, LogSink};
use super::remedy::optix_remedy;
use super::sys::{self, FunctionTable, OptixDeviceProperty, OptixResult};
use crate::error::{DriverError as Error, LogMessage, OptixFailure};

/// How a [`Context`] is made.
#[derive(Clone, Debug, Default)]
pub struct ContextOptions {
    /// The GPU, counted from 0 as in [`devices`](super::devices).
    pub ordinal: usize,
    /// Validation mode: slower, every launch is waited for and checked, and debug exceptions are on (guide 4.3).
    pub validation: bool,
    /// How much the driver logs.
    pub log_level: LogLevel,
    /// The compilation cache on disk.
    pub cache: DiskCache,
}

/// The compilation cache on disk (guide 4.2). The environment variable `OPTIX_CACHE_PATH` wins over [`Self::At`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum DiskCache {
    /// On, in the driver's default folder.
    #[default]
    Default,
    /// Off.
    Off,
    /// On, in this folder, which is created if it is missing. A network share is undefined behaviour.
    At(PathBuf),
}

/// A GPU ready for OptiX. Cheap to clone; the objects made from it keep it alive.
///
/// It uses the device's primary CUDA context, so memory of other CUDA code in the process is reachable, and one stream,
/// its own or other code's: builds, copies and launches run in the order they were asked for. Calls leave the thread's
/// current CUDA context as it was.
#[derive(Clone, Debug)]
pub struct Context(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    api: &'static Api,
    raw: sys::OptixDeviceContext,
    cuda: cu::CUcontext,
    device: cu::CUdevice,
    stream: cu::CUstream,
    /// The owner of the stream, if it is not this context's own.
    stream_owner: Option<Arc<dyn Any + Send + Sync>>,
    info: DeviceInfo,
    limits: Limits,
    validation: bool,
    log: Arc<LogSink>,
}

// SAFETY: the handles are not tied to a thread: CUDA's and OptiX's host functions may be called from any thread and at
// the same time, given that the CUDA context is current, which every method sees to.
unsafe impl Send for Inner {}
// SAFETY: as above.
unsafe impl Sync for Inner {}

impl std::fmt::Debug for Api {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Api").field(&self.abi.version).finish()
    }
}

impl Context {
    /// Loads the drivers and makes a context.
    ///
    /// # Errors
    /// [`Error::LibraryNotFound`] naming `libcuda.so.1` or `libnvoptix.so.1`, [`Error::NoDevice`],
    /// [`Error::UnsupportedDriver`], or the driver call that failed.
    pub fn new(options: &ContextOptions) -> Result<Self, Error> {
        Self::create(options, None)
    }

    /// As [`Self::new`], on a stream of other CUDA code, which `owner` keeps alive. What is asked for here and there runs
    /// in the order it was asked for.
    ///
    /// # Errors
    /// As [`Self::new`], and [`Error::Invalid`] where the stream is not of the GPU's primary context.
    ///
    /// # Safety
    /// The stream is live as long as `owner`.
    pub unsafe fn on_stream(
        options: &ContextOptions,
        stream: sys::CUstream,
        owner: Arc<dyn Any + Send + Sync>,
    ) -> Result<Self, Error> {
        Self::create(options, Some((stream, owner)))
    }

    fn create(
        options: &ContextOptions,
        other: Option<(sys::CUstream, Arc<dyn Any + Send + Sync>)>,
    ) -> Result<Self, Error> {
        cuda::init()?;
        let device = cuda::device(options.ordinal)?;
        let info = cuda::describe(options.ordinal)?;
        let api = library::api()?;
        // SAFETY: `device` was returned by cuDeviceGet.
        let cuda = cuda::check("cuDevicePrimaryCtxRetain", unsafe { result::primary_ctx::retain(device) }, Vec::new)?;
        // From here on, dropping `inner` releases what has been made.
        let mut inner = Inner {
            api,
            raw: sys::OptixDeviceContext::NULL,
            cuda,
            device,
            stream: std::ptr::null_mut(),
            stream_owner: None,
            info,
            limits: Limits::default(),
            validation: options.validation,
            log: Arc::new(LogSink::default()),
        };
        {
            let _current = inner.enter()?;
            match other {
                None => {
                    let kind = result::stream::StreamKind::NonBlocking;
                    inner.stream = inner.cuda("cuStreamCreate", result::stream::create(kind))?;
                }
                Some((stream, owner)) => {
                    inner.check_stream(stream)?;
                    (inner.stream, inner.stream_owner) = (stream, Some(owner));
                }
            }
            inner.raw = inner.create(options)?;
            inner.apply_cache(&options.cache)?;
            inner.limits = Limits::query(api.abi.version, |property| inner.property(property))?;
        }
        Ok(Self(Arc::new(inner)))
    }

    /// The GPU.
    pub fn info(&self) -> &DeviceInfo {
        &self.0.info
    }

    /// Limits and features.
    pub fn limits(&self) -> &Limits {
        &self.0.limits
    }

    /// The ABI version in use, such as 105.
    pub fn abi_version(&self) -> i32 {
        self.0.api.abi.version
    }

    /// The OptiX release that ABI version belongs to, such as `9.0`.
    pub fn optix_release(&self) -> &'static str {
        self.0.api.abi.release
    }

    /// Whether validation mode is on.
    pub fn validation(&self) -> bool {
        self.0.validation
    }

    /// Whether the driver's compilation cache on disk is on. It switches itself off where it can't write.
    pub fn cache_enabled(&self) -> Result<bool, Error> {
        let mut enabled = 0;
        // SAFETY: the context is live and `enabled` is valid for a write.
        let result = unsafe { self.table().device_context_get_cache_enabled(self.0.raw, &mut enabled) };
        self.check("optixDeviceContextGetCacheEnabled", result)?;
        Ok(enabled != 0)
    }

    /// What the driver logged, oldest first; the last 4096 messages are kept.
    pub fn messages(&self) -> Vec<LogMessage> {
        self.0.log.messages()
    }

    /// As [`Self::messages`], but the messages are not kept.
    pub fn take_messages(&self) -> Vec<LogMessage> {
        self.0.log.take_messages()
    }

    /// Waits until all work asked for so far is done.
    ///
    /// # Errors
    /// A fault of any earlier launch, build or copy on this context.
    pub fn synchronize(&self) -> Result<(), Error> {
        let _current = self.enter()?;
        // SAFETY: the stream is live and its context is current.
        self.cuda("cuStreamSynchronize", unsafe { result::stream::synchronize(self.0.stream) })
    }

    /// Whether both are the same context, so that objects of one may be used with the other.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }

    /// The primary CUDA context, for other CUDA code. Live as long as this object.
    pub fn cuda_context(&self) -> sys::CUcontext {
        self.0.cuda
    }

    /// The stream of this context, for other CUDA code. Live as long as this object.
    pub fn cuda_stream(&self) -> sys::CUstream {
        self.0.stream
    }

    /// What [`Self::on_stream`] was given to keep the stream alive.
    pub fn stream_owner(&self) -> Option<&Arc<dyn Any + Send + Sync>> {
        self.0.stream_owner.as_ref()
    }

    pub(super) fn table(&self) -> &'static FunctionTable {
        &self.0.api.table
    }

    pub(super) fn raw(&self) -> sys::OptixDeviceContext {
        self.0.raw
    }

    pub(super) fn enter(&self) -> Result<Current, Error> {
        self.0.enter()
    }

    pub(super) fn cuda<T>(&self, call: &'static str, result: Result<T, DriverError>) -> Result<T, Error> {
        self.0.cuda(call, result)
    }

    pub(super) fn check(&self, call: &'static str, result: OptixResult) -> Result<(), Error> {
        self.0.check(call, result, String::new)
    }

    pub(super) fn check_compile(&self, call: &'static str, result: OptixResult, log: &CompileLog) -> Result<(), Error> {
        self.0.check(call, result, || log.text())
    }

    /// Refuses an object of another context.
    pub(super) fn owns(&self, what: &'static str, other: &Self) -> Result<(), Error> {
        if self.is_same(other) {
            return Ok(());
        }
        let problem = "the objects belong to different contexts";
        Err(Error::invalid(what, problem, "make all objects of a pipeline from one context (guide 1)"))
    }
}

impl Inner {
    fn enter(&self) -> Result<Current, Error> {
        // SAFETY: the primary context was retained and is released only when `self` is dropped.
        self.cuda("cuCtxPushCurrent", unsafe { Current::push(self.cuda) })
    }

    fn cuda<T>(&self, call: &'static str, result: Result<T, DriverError>) -> Result<T, Error> {
        cuda::check(call, result, || self.log.take_unreported())
    }

    fn check(&self, call: &'static str, result: OptixResult, log: impl FnOnce() -> String) -> Result<(), Error> {
        if result == OptixResult::SUCCESS {
            return Ok(());
        }
        let text = |text: Option<&std::ffi::CStr>| text.map_or_else(String::new, |t| t.to_string_lossy().into_owned());
        Err(Error::Optix(Box::new(OptixFailure {
            call,
            name: text(self.api.table.get_error_name(result)),
            code: result.0,
            text: text(self.api.table.get_error_string(result)),
            remedy: optix_remedy(result),
            log: log(),
            messages: self.log.take_unreported(),
        })))
    }

    /// Whether other code's stream is of this GPU's primary context.
    fn check_stream(&self, stream: cu::CUstream) -> Result<(), Error> {
        let mut context = std::ptr::null_mut();
        // SAFETY: the stream is live, as `Context::on_stream` demands, and `context` is valid for a write.
        let result = unsafe { cu::cuStreamGetCtx(stream, &mut context) }.result();
        self.cuda("cuStreamGetCtx", result)?;
        if context == self.cuda {
            return Ok(());
        }
        let problem = format!("it is not of the primary context of GPU {}", self.info.ordinal);
        let remedy = "make the stream in that GPU's primary context; contexts of another kind can't be shared";
        Err(Error::invalid("a stream of other code", problem, remedy))
    }

    fn create(&self, options: &ContextOptions) -> Result<sys::OptixDeviceContext, Error> {
        let raw_options = sys::OptixDeviceContextOptions {
            log_callback_function: Some(log::receive),
            log_callback_data: Arc::as_ptr(&self.log).cast_mut().cast(),
            log_callback_level: options.log_level as i32,
            validation_mode: if options.validation {
                sys::OptixDeviceContextValidationMode::ALL
            } else {
                sys::OptixDeviceContextValidationMode::OFF
            },
        };
        let mut raw = sys::OptixDeviceContext::NULL;
        // SAFETY: the CUDA context is live, the pointers are to locals of the right type, and `self` keeps the log sink
        // alive until after the OptiX context is destroyed.
        let result = unsafe { self.api.table.device_context_create(self.cuda, &raw_options, &mut raw) };
        self.check("optixDeviceContextCreate", result, String::new)?;
        Ok(raw)
    }

    fn property(&self, property: OptixDeviceProperty) -> Result<u32, Error> {
        let mut value = 0u32;
        // SAFETY: the context is live; every property is a 32-bit integer, and that is the size passed.
        let result = unsafe {
            let (table, value) = (&self.api.table, (&raw mut value).cast());
            table.device_context_get_property(self.raw, property, value, size_of::<u32>())
        };
        self.check("optixDeviceContextGetProperty", result, String::new)?;
        Ok(value)
    }

    fn apply_cache(&self, cache: &DiskCache) -> Result<(), Error> {
        match cache {
            DiskCache::Default => Ok(()),
            DiskCache::Off => {
                // SAFETY: the context is live.
                let result = unsafe { self.api.table.device_context_set_cache_enabled(self.raw, 0) };
                self.check("optixDeviceContextSetCacheEnabled", result, String::new)
            }
            DiskCache::At(path) => {
                let remedy = "give a folder on a local disk whose name has no NUL character";
                let Ok(text) = CString::new(path.as_os_str().as_encoded_bytes()) else {
                    return Err(Error::invalid(
                        "the cache folder",
                        format!("{} has a NUL in it", path.display()),
                        remedy,
                    ));
                };
                // SAFETY: the context is live and `text` ends in NUL.
                let result = unsafe { self.api.table.device_context_set_cache_location(self.raw, text.as_ptr()) };
                self.check("optixDeviceContextSetCacheLocation", result, String::new)
            }
        }
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        // Errors have nowhere to go here; a lost CUDA context takes its objects with it.
        if let Ok(_current) = self.enter() {
            if !self.stream.is_null() {
                // SAFETY: the stream is live and its context is current.
                let _ = unsafe { result::stream::synchronize(self.stream) };
            }
            if self.raw != sys::OptixDeviceContext::NULL {
                // SAFETY: every object made from the context holds it, so none is left; the log sink is still alive.
                let _ = unsafe { self.api.table.device_context_destroy(self.raw) };
            }
            if !self.stream.is_null() && self.stream_owner.is_none() {
                // SAFETY: the stream is live, idle, and used by nobody else.
                let _ = unsafe { result::stream::destroy(self.stream) };
            }
        }
        // SAFETY: retained once in `Context::new`.
        let _ = unsafe { result::primary_ctx::release(self.device) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_context_is_made_or_the_missing_driver_is_named() {
        match Context::new(&ContextOptions { validation: true, ..Default::default() }) {
            Ok(context) => assert!(context.limits().max_trace_depth > 0),
            Err(Error::LibraryNotFound { library, .. }) => {
                assert!(["libcuda.so.1", "libnvoptix.so.1", "nvcuda.dll", "nvoptix.dll"].contains(&library));
            }
            Err(error) => assert!(error.to_string().contains("what to do"), "{error}"),
        }
    }

    #[test]
    fn an_absurd_ordinal_is_an_error() {
        let error = Context::new(&ContextOptions { ordinal: usize::MAX, ..Default::default() }).unwrap_err();
        assert!(error.to_string().contains("what to do"), "{error}");
    }
}
