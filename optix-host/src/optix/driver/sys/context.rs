//! Device context: creation options, log callback, properties (guide 4).

use core::ffi::{c_char, c_void};

/// Called by the driver with a level (1 fatal, 2 error, 3 warning, 4 print), a tag, a message and the pointer given at
/// creation, from any thread that is inside an OptiX call.
pub type OptixLogCallback =
    Option<unsafe extern "C" fn(level: u32, tag: *const c_char, message: *const c_char, data: *mut c_void)>;

abi_consts! {
    /// Which checks the driver makes at run time (guide 4.3).
    OptixDeviceContextValidationMode: u32 {
        OFF = 0,
        ALL = 0xffff_ffff,
    }

    /// A property that can be asked of a context (guide 4, 12). Each value is a 32-bit unsigned integer.
    OptixDeviceProperty: u32 {
        LIMIT_MAX_TRACE_DEPTH = 8193,
        LIMIT_MAX_TRAVERSABLE_GRAPH_DEPTH = 8194,
        LIMIT_MAX_PRIMITIVES_PER_GAS = 8195,
        LIMIT_MAX_INSTANCES_PER_IAS = 8196,
        RTCORE_VERSION = 8197,
        LIMIT_MAX_INSTANCE_ID = 8198,
        LIMIT_NUM_BITS_INSTANCE_VISIBILITY_MASK = 8199,
        LIMIT_MAX_SBT_RECORDS_PER_GAS = 8200,
        LIMIT_MAX_SBT_OFFSET = 8201,
        /// From ABI 87 on.
        SHADER_EXECUTION_REORDERING = 8202,
        /// From ABI 105 on.
        COOP_VEC = 8203,
        /// From ABI 105 on.
        CLUSTER_ACCEL = 8224,
        /// From ABI 105 on.
        LIMIT_MAX_CLUSTER_VERTICES = 8225,
        /// From ABI 105 on.
        LIMIT_MAX_CLUSTER_TRIANGLES = 8226,
        /// From ABI 105 on.
        LIMIT_MAX_STRUCTURED_GRID_RESOLUTION = 8227,
    }
}

abi_structs! {
    OptixDeviceContextOptions: size 24 align 8 {
        0 log_callback_function: OptixLogCallback,
        8 log_callback_data: *mut c_void,
        16 log_callback_level: i32,
        20 validation_mode: OptixDeviceContextValidationMode,
    }
}
