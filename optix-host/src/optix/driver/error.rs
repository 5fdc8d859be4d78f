//! What can go wrong, and what to do about it.

use std::fmt;

use super::log::LogMessage;
use super::sys::OptixResult;

/// An error of the OptiX backend: what was asked, what is wrong, what to do.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A driver library could not be loaded.
    #[error("{library} could not be loaded: {detail}\n  what to do: {remedy}")]
    LibraryNotFound {
        /// The file name that was searched for on the loader's default path.
        library: &'static str,
        /// The loader's own message.
        detail: String,
        /// What to do.
        remedy: &'static str,
    },

    /// The driver serves none of the ABI versions that this crate knows.
    #[error(
        "the driver serves none of the OptiX ABI versions {known:?} (its last answer: {code}), driver {driver}\n  \
         what to do: install NVIDIA driver {needed} or newer"
    )]
    UnsupportedDriver {
        /// The ABI versions asked for, newest first.
        known: Vec<i32>,
        /// The driver's last result code.
        code: i32,
        /// The display driver's version, or `unknown`.
        driver: String,
        /// The oldest driver branch that serves one of them.
        needed: u32,
    },

    /// There is no such GPU.
    #[error(
        "GPU {ordinal} was asked for, but CUDA sees {count}\n  what to do: check CUDA_VISIBLE_DEVICES and nvidia-smi"
    )]
    NoDevice {
        /// The GPU asked for, counted from 0.
        ordinal: usize,
        /// GPUs that CUDA sees.
        count: usize,
    },

    /// An OptiX call failed.
    #[error(transparent)]
    Optix(Box<OptixFailure>),

    /// A CUDA driver call failed.
    #[error(transparent)]
    Cuda(Box<CudaFailure>),

    /// An argument was refused before the driver saw it.
    #[error("{what}: {problem}\n  what to do: {remedy}")]
    Invalid {
        /// What was asked for.
        what: &'static str,
        /// What is wrong, with the values.
        problem: String,
        /// What to do.
        remedy: &'static str,
    },
}

/// As [`Display`](fmt::Display): what `main` prints of an error that it returns, and `unwrap` of one that it meets.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl Error {
    pub(super) fn invalid(what: &'static str, problem: impl Into<String>, remedy: &'static str) -> Self {
        Self::Invalid { what, problem: problem.into(), remedy }
    }

    /// The OptiX or CUDA result code, where a driver call failed.
    pub fn code(&self) -> Option<i32> {
        match self {
            Self::Optix(failure) => Some(failure.code),
            Self::Cuda(failure) => Some(failure.code),
            Self::UnsupportedDriver { code, .. } => Some(*code),
            _ => None,
        }
    }
}

/// A failed OptiX call.
#[derive(Debug)]
pub struct OptixFailure {
    /// The function of the API.
    pub call: &'static str,
    /// The result's name, as the driver gives it.
    pub name: String,
    /// The result's value.
    pub code: i32,
    /// The driver's sentence for it.
    pub text: String,
    /// The compile log, where the call compiles.
    pub log: String,
    /// What the driver logged at level 2 (error) or 1 (fatal) since the error before.
    pub messages: Vec<LogMessage>,
}

impl OptixFailure {
    /// The likely way out.
    pub fn remedy(&self) -> &'static str {
        optix_remedy(OptixResult(self.code))
    }
}

impl std::error::Error for OptixFailure {}

impl fmt::Display for OptixFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} returned {} ({}): {}", self.call, self.name, self.code, self.text)?;
        write!(f, "\n  what to do: {}", self.remedy())?;
        if !self.log.is_empty() {
            write!(f, "\n  compile log:\n{}", self.log.trim_end())?;
        }
        for message in &self.messages {
            write!(f, "\n  driver log: {message}")?;
        }
        Ok(())
    }
}

/// A failed CUDA driver call.
#[derive(Debug)]
pub struct CudaFailure {
    /// The function of the API.
    pub call: &'static str,
    /// The result's name, as the driver gives it.
    pub name: String,
    /// The result's value.
    pub code: i32,
    /// The driver's sentence for it.
    pub text: String,
    /// What OptiX logged at level 2 (error) or 1 (fatal) since the error before.
    pub messages: Vec<LogMessage>,
}

impl CudaFailure {
    /// The likely way out.
    pub fn remedy(&self) -> &'static str {
        cuda_remedy(self.code)
    }
}

impl std::error::Error for CudaFailure {}

impl fmt::Display for CudaFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} returned {} ({}): {}", self.call, self.name, self.code, self.text)?;
        write!(f, "\n  what to do: {}", self.remedy())?;
        for message in &self.messages {
            write!(f, "\n  OptiX log: {message}")?;
        }
        Ok(())
    }
}

fn optix_remedy(result: OptixResult) -> &'static str {
    match result {
        OptixResult::INVALID_VALUE => {
            "an argument is out of its range; the driver log names it when the context has validation switched on"
        }
        OptixResult::HOST_OUT_OF_MEMORY => "free host memory; compiling large modules needs the most",
        OptixResult::DEVICE_OUT_OF_MEMORY => {
            "free GPU memory: compact acceleration structures, build them one after another, lower the stack sizes"
        }
        OptixResult::INVALID_OPERATION => "the call does not fit the state of its object",
        OptixResult::FILE_IO_ERROR
        | OptixResult::DISK_CACHE_INVALID_PATH
        | OptixResult::DISK_CACHE_PERMISSION_ERROR
        | OptixResult::DISK_CACHE_DATABASE_ERROR
        | OptixResult::DISK_CACHE_INVALID_DATA => {
            "choose a writable local folder for the compilation cache (OPTIX_CACHE_PATH wins over the option), delete its \
             database, or switch the cache off"
        }
        OptixResult::LAUNCH_FAILURE => {
            "a program faulted: a null, freed or foreign address in the parameters or records, or a stack too small; \
             validation mode and the checked mode of the CPU executor find most of these"
        }
        OptixResult::INVALID_DEVICE_CONTEXT | OptixResult::INVALID_POINTER => {
            "an object of another context, or one already destroyed, was passed"
        }
        OptixResult::CUDA_NOT_INITIALIZED => "no CUDA context is current on this thread",
        OptixResult::VALIDATION_FAILURE => "validation mode caught an error in a program; the driver log says which",
        OptixResult::INVALID_INPUT | OptixResult::INVALID_FILE_FORMAT => {
            "the module is not PTX that this driver reads: the log gives the line; PTX of a newer .version or a newer \
             .target than the driver or GPU knows is refused too"
        }
        OptixResult::INVALID_LAUNCH_PARAMETER => {
            "the launch-parameter symbol must be a .const variable of one size in every module, and is given by name"
        }
        OptixResult::INVALID_PAYLOAD_ACCESS => {
            "a program reads or writes a payload word that its semantics or the payload's size do not allow"
        }
        OptixResult::INVALID_ATTRIBUTE_ACCESS => {
            "a program uses more attribute words than the pipeline options reserve"
        }
        OptixResult::INVALID_FUNCTION_USE => {
            "a program calls a device function that its kind may not call (guide §13), or recurses with device calls"
        }
        OptixResult::INVALID_FUNCTION_ARGUMENTS => {
            "a device function needs a compile-time constant or another register class there; the log gives the line"
        }
        OptixResult::PIPELINE_OUT_OF_CONSTANT_MEMORY => {
            "launch parameters and constant variables together exceed constant memory: move large tables to buffers"
        }
        OptixResult::PIPELINE_LINK_ERROR => {
            "a symbol is missing or defined twice among the modules, or their pipeline options differ"
        }
        OptixResult::INTERNAL_COMPILER_ERROR | OptixResult::INTERNAL_ERROR => {
            "an error inside the driver: try another driver version, optimisation level 0, or smaller programs, and report it"
        }
        OptixResult::NOT_COMPATIBLE => "the acceleration structure was made for another kind of GPU or driver",
        OptixResult::PAYLOAD_TYPE_MISMATCH
        | OptixResult::PAYLOAD_TYPE_RESOLUTION_FAILED
        | OptixResult::PAYLOAD_TYPE_ID_INVALID => {
            "all programs of a group must support the payload type given to the group, and it must be one of the module's"
        }
        OptixResult::NOT_SUPPORTED => "this GPU or driver does not have the feature",
        OptixResult::UNSUPPORTED_ABI_VERSION | OptixResult::FUNCTION_TABLE_SIZE_MISMATCH => {
            "the driver is too old: OptiX 7.7 needs driver 530, 8.0 needs 535, 8.1 needs 555, 9.0 needs 570"
        }
        OptixResult::INVALID_ENTRY_FUNCTION_OPTIONS | OptixResult::ENTRY_SYMBOL_NOT_FOUND => {
            "the driver library lacks the function: reinstall the NVIDIA driver"
        }
        OptixResult::LIBRARY_NOT_FOUND | OptixResult::LIBRARY_UNLOAD_FAILURE => {
            "a library of the NVIDIA driver is missing: reinstall the driver; in a container set \
             NVIDIA_DRIVER_CAPABILITIES=graphics,compute,utility"
        }
        OptixResult::CUDA_ERROR => {
            "CUDA failed inside OptiX, most often because an earlier launch read or wrote a bad address; after that the \
             CUDA context is lost and the process has to start again"
        }
        _ => "the driver log, at level 4, may say more",
    }
}

/// Values of `CUresult`, which are fixed by the CUDA driver API.
fn cuda_remedy(code: i32) -> &'static str {
    match code {
        2 => "free GPU memory, or choose a GPU with more",
        3 | 4 => "CUDA is not initialised in this process, or is shutting down",
        34 => "a stub libcuda.so is first on the library path: put the driver's own before it",
        35 | 803 => {
            "the driver is too old for the CUDA version in use, or its parts are of different versions: update it"
        }
        46 | 802 => "the GPU is in use or not ready yet: check nvidia-smi, compute mode and the fabric manager",
        100 | 101 => "no usable GPU: check nvidia-smi, CUDA_VISIBLE_DEVICES and the container's --gpus",
        201 | 709 => "the CUDA context is gone; the process has to start again",
        214 | 700 | 714 | 715 | 716 | 717 | 718 | 719 => {
            "a launch used a bad address or instruction: check the addresses in parameters and records, try validation \
             mode; the CUDA context is lost and the process has to start again"
        }
        702 => "a launch ran longer than the display watchdog allows: launch fewer indices at a time",
        999 => {
            "the kernel driver does not answer: check dmesg and nvidia-smi; after a driver update restart the machine"
        }
        _ => "see the CUDA driver API reference for this code",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_says_call_code_remedy_log_and_messages() {
        let failure = OptixFailure {
            call: "optixModuleCreate",
            name: "OPTIX_ERROR_INVALID_INPUT".into(),
            code: 7200,
            text: "Invalid input".into(),
            log: "COMPILE ERROR: line 3\n".into(),
            messages: vec![LogMessage { level: 2, tag: "COMPILER".into(), text: "bad".into() }],
        };
        let text = Error::Optix(Box::new(failure)).to_string();
        for part in ["optixModuleCreate", "7200", "what to do", "line 3", "[COMPILER] bad"] {
            assert!(text.contains(part), "{part} is missing in: {text}");
        }
    }

    #[test]
    fn every_listed_result_has_a_remedy_of_its_own() {
        for code in [7001, 7050, 7200, 7201, 7202, 7204, 7250, 7251, 7299, 7500, 7801, 7804, 7807, 7900, 7990] {
            assert_ne!(optix_remedy(OptixResult(code)), optix_remedy(OptixResult::UNKNOWN), "{code}");
        }
    }
}
