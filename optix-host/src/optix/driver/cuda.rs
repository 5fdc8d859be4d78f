//! The CUDA driver: loads it, lists the GPUs that it sees, and makes a context current for as long as a guard lives.

use std::sync::OnceLock;

use cudarc::driver::result::{self, DriverError};
use cudarc::driver::sys as cu;

use super::library;
use super::remedy::cuda_remedy;
use crate::error::{CudaFailure, DriverError as Error, LogMessage};

const LIBRARY: &str = if cfg!(windows) { "nvcuda.dll" } else { "libcuda.so.1" };

/// A GPU as CUDA describes it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceInfo {
    /// Position in CUDA's list, counted from 0.
    pub ordinal: usize,
    /// The product name.
    pub name: String,
    /// Compute capability: major, minor.
    pub compute_capability: (u32, u32),
    /// Device memory in bytes.
    pub memory_bytes: usize,
    /// The newest CUDA version the driver serves: major, minor.
    pub cuda_version: (u32, u32),
    /// The display driver's version, such as `580.95.05`, where the system tells.
    pub driver_version: Option<String>,
}

impl std::fmt::Display for DeviceInfo {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (major, minor) = self.compute_capability;
        let gibibytes = self.memory_bytes as f64 / f64::from(1 << 30);
        write!(f, "GPU {}: {}, compute capability {major}.{minor}", self.ordinal, self.name)?;
        let (major, minor) = self.cuda_version;
        let driver = self.driver_version.as_deref().unwrap_or("unknown");
        write!(f, ", {gibibytes:.1} GiB, driver {driver}, CUDA {major}.{minor}")
    }
}

/// The GPUs that CUDA sees. Empty when the driver is there and no GPU is.
///
/// # Errors
/// [`Error::LibraryNotFound`] without an NVIDIA driver, [`Error::Cuda`] when the driver refuses to start.
pub fn devices() -> Result<Vec<DeviceInfo>, Error> {
    if let Err(error) = init() {
        // CUDA_ERROR_NO_DEVICE is how the driver says that the list is empty.
        return if error.code() == Some(100) { Ok(Vec::new()) } else { Err(error) };
    }
    (0..count()?).map(describe).collect()
}

/// Loads and initialises the CUDA driver, once.
pub(super) fn init() -> Result<(), Error> {
    static PRESENT: OnceLock<()> = OnceLock::new();
    if PRESENT.get().is_none() {
        find_library()?;
        PRESENT.get_or_init(|| ());
    }
    check("cuInit", result::init(), Vec::new)
}

/// cudarc panics when it cannot find the library, so this has to come before any of its calls.
fn find_library() -> Result<(), Error> {
    // SAFETY: loading the NVIDIA driver's library runs its initialisers, which need nothing from us.
    let Err(detail) = (unsafe { libloading::Library::new(LIBRARY) }) else {
        return Ok(());
    };
    // SAFETY: as above, for the other names that cudarc looks for.
    if unsafe { cu::is_culib_present() } {
        return Ok(());
    }
    Err(Error::LibraryNotFound {
        library: LIBRARY,
        detail: library::chain(&detail),
        remedy: "this file comes with the NVIDIA driver: install it, or start the container with --gpus; without a GPU \
                 use the CPU executor",
    })
}

fn count() -> Result<usize, Error> {
    let count = check("cuDeviceGetCount", result::device::get_count(), Vec::new)?;
    Ok(usize::try_from(count).unwrap_or(0))
}

/// The CUDA handle of a GPU. Needs [`init`].
pub(super) fn device(ordinal: usize) -> Result<cu::CUdevice, Error> {
    let count = count()?;
    match i32::try_from(ordinal) {
        Ok(index) if ordinal < count => check("cuDeviceGet", result::device::get(index), Vec::new),
        _ => Err(Error::NoDevice { ordinal, count }),
    }
}

/// The position of a CUDA context's GPU in CUDA's list.
///
/// # Errors
/// As [`devices`].
///
/// # Safety
/// The context is live.
pub unsafe fn ordinal_of(context: cu::CUcontext) -> Result<usize, Error> {
    init()?;
    // SAFETY: the caller promises that the context is live.
    let _current = check("cuCtxPushCurrent", unsafe { Current::push(context) }, Vec::new)?;
    let mut wanted = 0;
    // SAFETY: a context is current, and `wanted` is valid for a write.
    check("cuCtxGetDevice", unsafe { cu::cuCtxGetDevice(&mut wanted) }.result(), Vec::new)?;
    let count = count()?;
    for ordinal in 0..count {
        if device(ordinal)? == wanted {
            return Ok(ordinal);
        }
    }
    Err(Error::NoDevice { ordinal: count, count })
}

/// Needs [`init`].
pub(super) fn describe(ordinal: usize) -> Result<DeviceInfo, Error> {
    use cu::CUdevice_attribute as Attribute;
    let device = device(ordinal)?;
    let attribute = |attribute| {
        // SAFETY: `device` was returned by cuDeviceGet.
        let value = unsafe { result::device::get_attribute(device, attribute) };
        Ok::<u32, Error>(check("cuDeviceGetAttribute", value, Vec::new)?.unsigned_abs())
    };
    let mut version = 0;
    // SAFETY: `version` is valid for a write.
    let result = unsafe { cu::cuDriverGetVersion(&mut version) }.result();
    check("cuDriverGetVersion", result, Vec::new)?;
    let version = version.unsigned_abs();
    // SAFETY: `device` was returned by cuDeviceGet.
    let memory = unsafe { result::device::total_mem(device) };
    Ok(DeviceInfo {
        ordinal,
        name: check("cuDeviceGetName", result::device::get_name(device), Vec::new)?,
        compute_capability: (
            attribute(Attribute::CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR)?,
            attribute(Attribute::CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MINOR)?,
        ),
        memory_bytes: check("cuDeviceTotalMem", memory, Vec::new)?,
        // 13000 is 13.0, 12080 is 12.8.
        cuda_version: (version / 1000, version % 1000 / 10),
        driver_version: display_driver_version(),
    })
}

/// The version of the loaded NVIDIA kernel module, from `/proc/driver/nvidia/version`.
pub(super) fn display_driver_version() -> Option<String> {
    parse_driver_version(&std::fs::read_to_string("/proc/driver/nvidia/version").ok()?)
}

/// The first word made of two or more numbers with dots between.
fn parse_driver_version(text: &str) -> Option<String> {
    let is_version = |word: &&str| {
        word.contains('.') && word.split('.').all(|part| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit()))
    };
    text.split_whitespace().find(is_version).map(str::to_owned)
}

/// Turns a CUDA result into ours; `messages` gives the OptiX log to attach.
pub(super) fn check<T>(
    call: &'static str,
    result: Result<T, DriverError>,
    messages: impl FnOnce() -> Vec<LogMessage>,
) -> Result<T, Error> {
    result.map_err(|error| {
        let text = |text: Result<&std::ffi::CStr, DriverError>| {
            text.map_or_else(|_| "unknown".to_owned(), |text| text.to_string_lossy().into_owned())
        };
        Error::Cuda(Box::new(CudaFailure {
            call,
            name: text(error.error_name()),
            code: error.0 as i32,
            text: text(error.error_string()),
            remedy: cuda_remedy(error.0 as i32),
            messages: messages(),
        }))
    })
}

/// A CUDA context that is current on this thread until the guard is dropped; then the one before is again.
pub(super) struct Current {
    // The guard must be dropped on the thread that made it.
    _not_send: std::marker::PhantomData<*const ()>,
}

impl Current {
    /// # Safety
    /// `context` is a live CUDA context.
    pub(super) unsafe fn push(context: cu::CUcontext) -> Result<Self, DriverError> {
        // SAFETY: the caller promises that the context is live.
        unsafe { cu::cuCtxPushCurrent_v2(context) }.result()?;
        Ok(Self { _not_send: std::marker::PhantomData })
    }
}

impl Drop for Current {
    fn drop(&mut self) {
        let mut popped = std::ptr::null_mut();
        // SAFETY: `push` put a context on this thread's stack, and `popped` is valid for a write. An error of earlier
        // device work may come back here; it is sticky, so the next checked call reports it.
        let _ = unsafe { cu::cuCtxPopCurrent_v2(&mut popped) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_driver_version_is_found_in_both_forms_of_the_file() {
        let closed = "NVRM version: NVIDIA UNIX x86_64 Kernel Module  535.183.01  Sun May 12 19:39:15 UTC 2024\nGCC version: 12.3.0";
        let open = "NVRM version: NVIDIA UNIX Open Kernel Module for x86_64  580.95.05  Release Build  (x)";
        assert_eq!(parse_driver_version(closed).as_deref(), Some("535.183.01"));
        assert_eq!(parse_driver_version(open).as_deref(), Some("580.95.05"));
        assert_eq!(parse_driver_version("no numbers here. ..."), None);
    }

    #[test]
    fn a_device_is_described_in_a_line() {
        let device = DeviceInfo {
            ordinal: 1,
            name: "A GPU".into(),
            compute_capability: (9, 0),
            memory_bytes: 3 << 29,
            cuda_version: (13, 0),
            driver_version: Some("580.95.05".into()),
        };
        let text = "GPU 1: A GPU, compute capability 9.0, 1.5 GiB, driver 580.95.05, CUDA 13.0";
        assert_eq!(device.to_string(), text);
    }

    #[test]
    fn without_a_driver_the_error_names_the_file() {
        match devices() {
            Ok(devices) => assert!(devices.iter().enumerate().all(|(i, device)| device.ordinal == i)),
            Err(Error::LibraryNotFound { library, .. }) => assert_eq!(library, LIBRARY),
            Err(error) => assert!(matches!(error, Error::Cuda(_)), "{error}"),
        }
    }
}
