//! What to do about the result codes of the drivers.

use super::sys::OptixResult;

/// What to do about an OptiX call that failed with this result.
pub(super) fn optix_remedy(result: OptixResult) -> &'static str {
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
        OptixResult::VALIDATION_FAILURE => {
            "validation mode caught an error in a program; the driver log says which. An internal traversal stack overflow is no \
             error of a program: geometry over many scales makes structures so deep, and outside of validation mode the \
             pipeline's stack has a reserve for it"
        }
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
            "a program calls a device function that its kind may not call (guide 13), or recurses with device calls"
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

/// What to do about a CUDA call that failed with this code. The CUDA driver API fixes the values of `CUresult`.
pub(crate) fn cuda_remedy(code: i32) -> &'static str {
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
    fn every_listed_result_has_a_remedy_of_its_own() {
        for code in [7001, 7050, 7200, 7201, 7202, 7204, 7250, 7251, 7299, 7500, 7801, 7804, 7807, 7900, 7990] {
            assert_ne!(optix_remedy(OptixResult(code)), optix_remedy(OptixResult::UNKNOWN), "{code}");
        }
    }
}
