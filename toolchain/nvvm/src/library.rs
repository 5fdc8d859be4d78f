//! A loaded libNVVM, and calls of its functions.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::fmt;
use std::path::{Path, PathBuf};

use libloading::Symbol;

use super::{PtxVersion, Translated};

type Program = *mut c_void;
type Version = unsafe extern "C" fn(*mut c_int, *mut c_int) -> c_int;
type IrVersion = unsafe extern "C" fn(*mut c_int, *mut c_int, *mut c_int, *mut c_int) -> c_int;
type ErrorString = unsafe extern "C" fn(c_int) -> *const c_char;
type OnProgram = unsafe extern "C" fn(*mut Program) -> c_int;
type AddModule = unsafe extern "C" fn(Program, *const c_char, usize, *const c_char) -> c_int;
type Run = unsafe extern "C" fn(Program, c_int, *const *const c_char) -> c_int;
type Size = unsafe extern "C" fn(Program, *mut usize) -> c_int;
type Get = unsafe extern "C" fn(Program, *mut c_char) -> c_int;

/// A libNVVM that was loaded.
#[derive(Debug)]
pub struct Library {
    /// The file.
    pub path: PathBuf,
    library: libloading::Library,
}

/// Why libNVVM did not do what it was asked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// What it was asked.
    pub doing: &'static str,
    /// What it said.
    pub reason: String,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "libNVVM: {}: {}", self.doing, self.reason.trim())
    }
}

impl std::error::Error for Failure {}

impl Library {
    /// Loads the library in the file.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        // SAFETY: this is NVIDIA's own library, whose initialisers have no precondition.
        let library = unsafe { libloading::Library::new(path) };
        let library = library.map_err(|e| Failure { doing: "loading", reason: e.to_string() })?;
        let this = Self { path: path.to_path_buf(), library };
        this.ir_version()?;
        Ok(this)
    }

    /// The NVVM IR that it reads.
    pub fn ir_version(&self) -> Result<(i32, i32), Failure> {
        let (mut major, mut minor, mut debug) = (0, 0, (0, 0));
        // SAFETY: this is nvvmIRVersion's type, and the pointers are to live integers.
        let result =
            unsafe { self.function::<IrVersion>("nvvmIRVersion")?(&mut major, &mut minor, &mut debug.0, &mut debug.1) };
        self.check("version of its IR", result)?;
        Ok((major, minor))
    }

    /// Its own version.
    pub fn version(&self) -> Result<(i32, i32), Failure> {
        let (mut major, mut minor) = (0, 0);
        // SAFETY: this is nvvmVersion's type, and the pointers are to live integers.
        let result = unsafe { self.function::<Version>("nvvmVersion")?(&mut major, &mut minor) };
        self.check("version", result)?;
        Ok((major, minor))
    }

    /// The version of PTX that it writes; drivers refuse newer ones than they know.
    pub fn ptx_version(&self) -> Result<PtxVersion, Failure> {
        let nothing = super::translate("define void @nothing() {\n  ret void\n}\n", super::Dialect::Llvm7)
            .map_err(|e| Failure { doing: "a first program", reason: e.to_string() })?;
        let ptx = self.compile(&nothing, None, &["-arch=compute_75".to_string()])?;
        let version = ptx.lines().find_map(|line| line.strip_prefix(".version "));
        version
            .and_then(PtxVersion::parse)
            .ok_or_else(|| Failure { doing: "a first program", reason: "its PTX says no version".into() })
    }

    /// Verifies a module and compiles it to PTX. `libdevice` is the library of mathematical functions, if it needs it.
    /// The options are nvcc's: `-arch=compute_75`, `-ftz=1`, `-prec-div=0`, `-prec-sqrt=0`, `-fma=0`.
    pub fn compile(
        &self,
        module: &Translated,
        libdevice: Option<&[u8]>,
        options: &[String],
    ) -> Result<String, Failure> {
        let options: Vec<CString> = options.iter().filter_map(|option| CString::new(option.as_str()).ok()).collect();
        let pointers: Vec<*const c_char> = options.iter().map(|option| option.as_ptr()).collect();
        let count = c_int::try_from(pointers.len()).unwrap_or(0);
        let program = OpenProgram::new(self)?;
        program.add("nvvmAddModuleToProgram", module.text.as_bytes(), c"shaders")?;
        if let Some(libdevice) = libdevice {
            // Only those functions of libdevice that are called become a part of the program.
            program.add("nvvmLazyAddModuleToProgram", libdevice, c"libdevice")?;
        }
        for (function, doing) in [("nvvmVerifyProgram", "verification"), ("nvvmCompileProgram", "compilation")] {
            // SAFETY: both functions have this type; the pointers are to strings that end with a zero and live on.
            let result = unsafe { self.function::<Run>(function)?(program.handle, count, pointers.as_ptr()) };
            if result != 0 {
                let log = program.text("nvvmGetProgramLogSize", "nvvmGetProgramLog").unwrap_or_default();
                let error = self.check(doing, result).err().map(|failure| failure.reason).unwrap_or_default();
                return Err(Failure { doing, reason: format!("{error}: {}", log.trim()) });
            }
        }
        program.text("nvvmGetCompiledResultSize", "nvvmGetCompiledResult")
    }

    /// Gets a function out of the library.
    ///
    /// # Safety
    /// `T` must be the function's type.
    unsafe fn function<T>(&self, name: &str) -> Result<Symbol<'_, T>, Failure> {
        // SAFETY: the caller promises the type.
        unsafe { self.library.get(name) }.map_err(|e| Failure { doing: "loading", reason: e.to_string() })
    }

    fn check(&self, doing: &'static str, result: c_int) -> Result<(), Failure> {
        if result == 0 {
            return Ok(());
        }
        // SAFETY: this is nvvmGetErrorString's type; it returns a string that is never freed.
        let reason = unsafe {
            let text = self.function::<ErrorString>("nvvmGetErrorString")?(result);
            if text.is_null() { String::new() } else { CStr::from_ptr(text).to_string_lossy().into_owned() }
        };
        Err(Failure { doing, reason })
    }
}

/// A program, which is destroyed on drop.
struct OpenProgram<'l> {
    library: &'l Library,
    handle: Program,
}

impl<'l> OpenProgram<'l> {
    fn new(library: &'l Library) -> Result<Self, Failure> {
        let mut handle = std::ptr::null_mut();
        // SAFETY: this is nvvmCreateProgram's type, and the pointer is to a live handle.
        let result = unsafe { library.function::<OnProgram>("nvvmCreateProgram")?(&mut handle) };
        library.check("a new program", result)?;
        Ok(Self { library, handle })
    }

    fn add(&self, function: &str, text: &[u8], name: &CStr) -> Result<(), Failure> {
        // SAFETY: both functions that add have this type; the text is as long as is said, and is copied.
        let result = unsafe {
            self.library.function::<AddModule>(function)?(self.handle, text.as_ptr().cast(), text.len(), name.as_ptr())
        };
        self.library.check("adding a module", result)
    }

    /// Gets a text from the library: first its size, then the text.
    fn text(&self, size_of: &str, get: &str) -> Result<String, Failure> {
        let mut size = 0;
        // SAFETY: this is the type of the functions for sizes, and the pointer is to a live integer.
        let result = unsafe { self.library.function::<Size>(size_of)?(self.handle, &mut size) };
        self.library.check("the size of the result", result)?;
        let mut text = vec![0_u8; size];
        // SAFETY: this is the type of the functions for texts, and the buffer has the size that the library asks for.
        let result = unsafe { self.library.function::<Get>(get)?(self.handle, text.as_mut_ptr().cast()) };
        self.library.check("the result", result)?;
        // The zero at its end.
        text.retain(|byte| *byte != 0);
        Ok(String::from_utf8_lossy(&text).into_owned())
    }
}

impl Drop for OpenProgram<'_> {
    fn drop(&mut self) {
        // SAFETY: this is nvvmDestroyProgram's type; the handle is a program's, and nobody uses it from here on.
        unsafe {
            if let Ok(destroy) = self.library.function::<OnProgram>("nvvmDestroyProgram") {
                destroy(&mut self.handle);
            }
        }
    }
}
