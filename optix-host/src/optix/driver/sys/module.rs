//! Modules: compile options, bound values, payload types, built-in intersection programs (guide 6.3, 6.5.1, 14).

use core::ffi::{c_char, c_void};

abi_consts! {
    /// How hard the compiler optimises. 0 lets the driver choose, which today is level 3.
    OptixCompileOptimizationLevel: u32 {
        DEFAULT = 0,
        LEVEL_0 = 9024,
        LEVEL_1 = 9025,
        LEVEL_2 = 9026,
        LEVEL_3 = 9027,
    }

    /// How much debug information is kept. 0 lets the driver choose, which today is minimal.
    OptixCompileDebugLevel: u32 {
        DEFAULT = 0,
        NONE = 9040,
        MINIMAL = 9041,
        /// Larger than `MODERATE` in effect, smaller in value.
        FULL = 9042,
        MODERATE = 9043,
    }

    /// One kind of primitive.
    OptixPrimitiveType: u32 {
        CUSTOM = 9472,
        ROUND_QUADRATIC_BSPLINE = 9473,
        ROUND_CUBIC_BSPLINE = 9474,
        ROUND_LINEAR = 9475,
        ROUND_CATMULLROM = 9476,
        FLAT_QUADRATIC_BSPLINE = 9477,
        SPHERE = 9478,
        ROUND_CUBIC_BEZIER = 9479,
        /// This and the other `ROCAPS` kinds: from ABI 105 on.
        ROUND_QUADRATIC_BSPLINE_ROCAPS = 9480,
        ROUND_CUBIC_BSPLINE_ROCAPS = 9481,
        ROUND_CATMULLROM_ROCAPS = 9482,
        ROUND_CUBIC_BEZIER_ROCAPS = 9483,
        TRIANGLE = 9521,
    }
}

abi_structs! {
    /// One range of the launch parameters that the compiler may replace by constants.
    OptixModuleCompileBoundValueEntry: size 32 align 8 {
        0 pipeline_param_offset_in_bytes: usize,
        8 size_in_bytes: usize,
        16 bound_value_ptr: *const c_void,
        24 annotation: *const c_char,
    }

    /// A payload: how many 32-bit words, and for each who reads and writes it.
    OptixPayloadType: size 16 align 8 {
        0 num_payload_values: u32,
        8 payload_semantics: *const u32,
    }

    OptixModuleCompileOptions: size 40 align 8 {
        0 max_register_count: i32,
        4 opt_level: OptixCompileOptimizationLevel,
        8 debug_level: OptixCompileDebugLevel,
        16 bound_values: *const OptixModuleCompileBoundValueEntry,
        24 num_bound_values: u32,
        28 num_payload_types: u32,
        32 payload_types: *const OptixPayloadType,
    }

    /// Which built-in intersection program to make.
    OptixBuiltinISOptions: size 16 align 4 {
        0 builtin_is_module_type: OptixPrimitiveType,
        4 uses_motion_blur: i32,
        8 build_flags: u32,
        12 curve_endcap_flags: u32,
    }
}
