//! NVIDIA's shared libraries: finding them and asking for their versions.

use std::ffi::{CStr, c_char, c_int, c_uint, c_void};

use libloading::{AsFilename, Library, Symbol};

/// OptiX, which is part of the driver.
pub(super) const OPTIX: &str = if cfg!(windows) { "nvoptix.dll" } else { "libnvoptix.so.1" };
const CUDA: &str = if cfg!(windows) { "nvcuda.dll" } else { "libcuda.so.1" };

/// The version of OptiX's function table that is asked for, and its number of functions: OptiX 9.0.
pub(super) const OPTIX_ABI: c_int = 105;
const OPTIX_FUNCTIONS: usize = 52;

/// Loads a library by name or path.
pub(super) fn open(library: impl AsFilename) -> Result<Library, String> {
    // SAFETY: these are NVIDIA's own libraries, whose initialisers have no precondition.
    unsafe { Library::new(library) }.map_err(|e| e.to_string())
}

/// Gets a function out of a library.
///
/// # Safety
/// `T` must be the function's type.
unsafe fn function<'a, T>(library: &'a Library, name: &str) -> Result<Symbol<'a, T>, String> {
    // SAFETY: the caller promises the type.
    unsafe { library.get(name) }.map_err(|e| e.to_string())
}

/// A GPU as CUDA sees it.
pub(super) struct Gpu {
    pub name: String,
    pub compute_capability: (c_int, c_int),
}

/// The driver's CUDA version, and its GPUs.
pub(super) struct Driver {
    pub cuda: (c_int, c_int),
    pub gpus: Vec<Gpu>,
}

impl Driver {
    /// Asks the driver. The error says what it lacks.
    pub fn query() -> Result<Self, String> {
        const MAJOR: c_int = 75;
        const MINOR: c_int = 76;
        type Init = unsafe extern "system" fn(c_uint) -> c_int;
        type GetVersion = unsafe extern "system" fn(*mut c_int) -> c_int;
        type Get = unsafe extern "system" fn(*mut c_int, c_int) -> c_int;
        type GetName = unsafe extern "system" fn(*mut c_char, c_int, c_int) -> c_int;
        type GetAttribute = unsafe extern "system" fn(*mut c_int, c_int, c_int) -> c_int;

        let library = open(CUDA)?;
        // SAFETY: the types are those of the CUDA driver API, which has them unchanged since version 2; each pointer
        // is to a live value of the type that is written, and `cuInit` comes before what needs it.
        unsafe {
            let mut version = 0;
            function::<GetVersion>(&library, "cuDriverGetVersion")?(&mut version);
            let mut driver = Self { cuda: (version / 1000, version % 1000 / 10), gpus: Vec::new() };
            let mut count = 0;
            let ready = function::<Init>(&library, "cuInit")?(0) == 0
                && function::<GetVersion>(&library, "cuDeviceGetCount")?(&mut count) == 0;
            for ordinal in 0..if ready { count } else { 0 } {
                let (mut device, mut major, mut minor) = (0, 0, 0);
                let mut name = [0; 256];
                function::<Get>(&library, "cuDeviceGet")?(&mut device, ordinal);
                // The last byte stays zero.
                function::<GetName>(&library, "cuDeviceGetName")?(name.as_mut_ptr(), 255, device);
                let attribute = function::<GetAttribute>(&library, "cuDeviceGetAttribute")?;
                attribute(&mut major, MAJOR, device);
                attribute(&mut minor, MINOR, device);
                let name = CStr::from_ptr(name.as_ptr()).to_string_lossy().into_owned();
                driver.gpus.push(Gpu { name, compute_capability: (major, minor) });
            }
            Ok(driver)
        }
    }
}

/// Whether the installed OptiX speaks [`OPTIX_ABI`]; the error says what is missing.
pub(super) fn optix_accepts_abi() -> Result<bool, String> {
    type Query = unsafe extern "C" fn(c_int, c_uint, *mut c_void, *const *const c_void, *mut c_void, usize) -> c_int;
    let library = open(OPTIX)?;
    let mut table = [0_usize; OPTIX_FUNCTIONS];
    // SAFETY: the type is that of the one function which the library exports; with no options their pointers are not
    // read; the table is as large as is said.
    let result = unsafe {
        let query = function::<Query>(&library, "optixQueryFunctionTable")?;
        query(OPTIX_ABI, 0, std::ptr::null_mut(), std::ptr::null(), table.as_mut_ptr().cast(), size_of_val(&table))
    };
    Ok(result == 0)
}
