//! Pipelines, the shader binding table and launches (guide 6.3, 6.7, 7, 10).

use core::ffi::c_char;

use super::CUdeviceptr;

abi_consts! {
    /// Which traversable graphs a pipeline traces. A set of bits; 0 allows any graph.
    OptixTraversableGraphFlags: u32 {
        ALLOW_ANY = 0,
        ALLOW_SINGLE_GAS = 1,
        ALLOW_SINGLE_LEVEL_INSTANCING = 2,
    }

    /// Which exceptions are raised. A set of bits.
    OptixExceptionFlags: u32 {
        NONE = 0,
        STACK_OVERFLOW = 1,
        TRACE_DEPTH = 2,
        USER = 4,
    }

    /// Which primitive kinds a pipeline meets. A set of bits; 0 means triangles and custom primitives.
    OptixPrimitiveTypeFlags: u32 {
        CUSTOM = 1,
        ROUND_QUADRATIC_BSPLINE = 1 << 1,
        ROUND_CUBIC_BSPLINE = 1 << 2,
        ROUND_LINEAR = 1 << 3,
        ROUND_CATMULLROM = 1 << 4,
        FLAT_QUADRATIC_BSPLINE = 1 << 5,
        SPHERE = 1 << 6,
        ROUND_CUBIC_BEZIER = 1 << 7,
        /// This and the other `ROCAPS` kinds: from ABI 105 on.
        ROUND_QUADRATIC_BSPLINE_ROCAPS = 1 << 8,
        ROUND_CUBIC_BSPLINE_ROCAPS = 1 << 9,
        ROUND_CATMULLROM_ROCAPS = 1 << 10,
        ROUND_CUBIC_BEZIER_ROCAPS = 1 << 11,
        TRIANGLE = 1 << 31,
    }
}

abi_structs! {
    /// Options shared by all modules of a pipeline, as of ABI 105.
    OptixPipelineCompileOptions: size 48 align 8 {
        0 uses_motion_blur: i32,
        4 traversable_graph_flags: u32,
        8 num_payload_values: i32,
        12 num_attribute_values: i32,
        16 exception_flags: u32,
        24 pipeline_launch_params_variable_name: *const c_char,
        32 uses_primitive_type_flags: u32,
        36 allow_opacity_micromaps: i32,
        40 allow_clustered_geometry: i32,
    }

    /// The same options in ABI 84 to 93: a prefix of [`OptixPipelineCompileOptions`], so a pointer to the newer
    /// structure serves an older driver, which reads only this much of it.
    OptixPipelineCompileOptionsV84: size 40 align 8 {
        0 uses_motion_blur: i32,
        4 traversable_graph_flags: u32,
        8 num_payload_values: i32,
        12 num_attribute_values: i32,
        16 exception_flags: u32,
        24 pipeline_launch_params_variable_name: *const c_char,
        32 uses_primitive_type_flags: u32,
        36 allow_opacity_micromaps: i32,
    }

    OptixPipelineLinkOptions: size 4 align 4 {
        0 max_trace_depth: u32,
    }

    OptixShaderBindingTable: size 64 align 8 {
        0 raygen_record: CUdeviceptr,
        8 exception_record: CUdeviceptr,
        16 miss_record_base: CUdeviceptr,
        24 miss_record_stride_in_bytes: u32,
        28 miss_record_count: u32,
        32 hitgroup_record_base: CUdeviceptr,
        40 hitgroup_record_stride_in_bytes: u32,
        44 hitgroup_record_count: u32,
        48 callables_record_base: CUdeviceptr,
        56 callables_record_stride_in_bytes: u32,
        60 callables_record_count: u32,
    }
}
