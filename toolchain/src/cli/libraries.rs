//! NVIDIA's shared libraries: finding them and asking for their versions.

use std::ffi::{CStr, c_char, c_int, c_uint, c_void};
use std::path::{Path, PathBuf};
use std::process::Command;

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

/// A libNVVM on this machine.
pub(super) struct Nvvm {
    /// The file itself, whose path tells the version of the toolkit; links do not.
    pub path: PathBuf,
    /// The NVVM IR it reads.
    pub ir: (c_int, c_int),
}

/// Every libNVVM in the places where CUDA toolkits, drivers and Python wheels put it.
pub(super) fn nvvm() -> Vec<Nvvm> {
    let mut files: Vec<PathBuf> = nvvm_paths().iter().filter_map(|path| path.canonicalize().ok()).collect();
    files.sort();
    files.dedup();
    let open = |path: PathBuf| nvvm_ir(&path).ok().map(|ir| Nvvm { path, ir });
    files.into_iter().filter_map(open).collect()
}

fn nvvm_ir(path: &Path) -> Result<(c_int, c_int), String> {
    type Version = unsafe extern "C" fn(*mut c_int, *mut c_int, *mut c_int, *mut c_int) -> c_int;
    let library = open(path)?;
    let (mut major, mut minor, mut debug) = (0, 0, (0, 0));
    // SAFETY: this is nvvmIRVersion's type, and the pointers are to live integers.
    unsafe {
        let version = function::<Version>(&library, "nvvmIRVersion")?;
        version(&mut major, &mut minor, &mut debug.0, &mut debug.1);
    }
    Ok((major, minor))
}

fn nvvm_paths() -> Vec<PathBuf> {
    let mut folders = Vec::new();
    for name in ["CUDA_HOME", "CUDA_PATH", "CUDA_ROOT"] {
        folders.extend(std::env::var_os(name).map(|root| PathBuf::from(root).join("nvvm/lib64")));
    }
    folders.extend(list(Path::new("/usr/local"), "cuda").into_iter().map(|root| root.join("nvvm/lib64")));
    folders.push("/opt/cuda/nvvm/lib64".into());
    // The driver has one too, under a name of its own.
    folders.extend(["/usr/lib/x86_64-linux-gnu", "/usr/lib64", "/usr/lib/aarch64-linux-gnu"].map(PathBuf::from));
    folders.extend(std::env::var_os("LD_LIBRARY_PATH").iter().flat_map(std::env::split_paths));
    for packages in python_packages() {
        let nvidia = packages.join("nvidia");
        folders.push(nvidia.join("cuda_nvcc/nvvm/lib64"));
        folders.extend(list(&nvidia, "cu").into_iter().flat_map(|cu| [cu.join("lib"), cu.join("nvvm/lib64")]));
    }
    let libraries = folders.iter().flat_map(|dir| ["libnvvm.so", "libnvidia-nvvm.so"].map(|name| list(dir, name)));
    libraries.flatten().collect()
}

/// Where the Python in use has its packages.
fn python_packages() -> Vec<PathBuf> {
    let script = "import site; print('\\n'.join(site.getsitepackages() + [site.getusersitepackages()]))";
    let output = Command::new("python3").args(["-c", script]).output();
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    text.lines().map(PathBuf::from).collect()
}

/// The entries of a folder whose names start with `prefix`, in order.
fn list(dir: &Path, prefix: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(dir).map(|entries| entries.flatten().collect()).unwrap_or_else(|_| Vec::new());
    let matching = entries.iter().filter(|entry| entry.file_name().to_string_lossy().starts_with(prefix));
    let mut paths: Vec<PathBuf> = matching.map(|entry| entry.path()).collect();
    paths.sort();
    paths
}
