//! Acceleration structures: build inputs, options, instances, emitted properties (guide 5).

use super::{CUdeviceptr, OptixPrimitiveType, OptixTraversableHandle};

abi_consts! {
    /// Which member of [`OptixBuildInputUnion`] counts.
    OptixBuildInputType: u32 {
        TRIANGLES = 8513,
        CUSTOM_PRIMITIVES = 8514,
        INSTANCES = 8515,
        INSTANCE_POINTERS = 8516,
        CURVES = 8517,
        SPHERES = 8518,
    }

    OptixIndicesFormat: u32 {
        NONE = 0,
        /// From ABI 93 on.
        UNSIGNED_BYTE3 = 8449,
        UNSIGNED_SHORT3 = 8450,
        UNSIGNED_INT3 = 8451,
    }

    OptixVertexFormat: u32 {
        NONE = 0,
        FLOAT3 = 8481,
        FLOAT2 = 8482,
        HALF3 = 8483,
        HALF2 = 8484,
        SNORM16_3 = 8485,
        SNORM16_2 = 8486,
    }

    OptixTransformFormat: u32 {
        NONE = 0,
        MATRIX_FLOAT12 = 8673,
    }

    /// A set of bits, with one entry for each record (guide 5.1).
    OptixGeometryFlags: u32 {
        NONE = 0,
        DISABLE_ANYHIT = 1,
        REQUIRE_SINGLE_ANYHIT_CALL = 2,
        DISABLE_TRIANGLE_FACE_CULLING = 4,
    }

    /// A set of bits (guide 5.4).
    OptixInstanceFlags: u32 {
        NONE = 0,
        DISABLE_TRIANGLE_FACE_CULLING = 1,
        FLIP_TRIANGLE_FACING = 2,
        DISABLE_ANYHIT = 4,
        ENFORCE_ANYHIT = 8,
        FORCE_OPACITY_MICROMAP_2_STATE = 16,
        DISABLE_OPACITY_MICROMAPS = 32,
    }

    /// A set of bits (guide 5.5).
    OptixBuildFlags: u32 {
        NONE = 0,
        ALLOW_UPDATE = 1,
        ALLOW_COMPACTION = 2,
        PREFER_FAST_TRACE = 4,
        PREFER_FAST_BUILD = 8,
        ALLOW_RANDOM_VERTEX_ACCESS = 16,
        ALLOW_RANDOM_INSTANCE_ACCESS = 32,
        ALLOW_OPACITY_MICROMAP_UPDATE = 64,
        ALLOW_DISABLE_OPACITY_MICROMAPS = 128,
    }

    OptixBuildOperation: u32 {
        BUILD = 8545,
        UPDATE = 8546,
    }

    /// A set of bits (guide 5.10.1).
    OptixMotionFlags: u16 {
        NONE = 0,
        START_VANISH = 1,
        END_VANISH = 2,
    }

    OptixAccelPropertyType: u32 {
        COMPACTED_SIZE = 8577,
        AABBS = 8578,
    }
}

abi_structs! {
    OptixOpacityMicromapUsageCount: size 12 align 4 {
        0 count: u32,
        4 subdivision_level: u32,
        8 format: u32,
    }

    OptixBuildInputOpacityMicromap: size 48 align 8 {
        0 indexing_mode: u32,
        8 opacity_micromap_array: CUdeviceptr,
        16 index_buffer: CUdeviceptr,
        24 index_size_in_bytes: u32,
        28 index_stride_in_bytes: u32,
        32 index_offset: u32,
        36 num_micromap_usage_counts: u32,
        40 micromap_usage_counts: *const OptixOpacityMicromapUsageCount,
    }

    OptixBuildInputTriangleArray: size 240 align 8 {
        0 vertex_buffers: *const CUdeviceptr,
        8 num_vertices: u32,
        12 vertex_format: OptixVertexFormat,
        16 vertex_stride_in_bytes: u32,
        24 index_buffer: CUdeviceptr,
        32 num_index_triplets: u32,
        36 index_format: OptixIndicesFormat,
        40 index_stride_in_bytes: u32,
        48 pre_transform: CUdeviceptr,
        56 flags: *const u32,
        64 num_sbt_records: u32,
        72 sbt_index_offset_buffer: CUdeviceptr,
        80 sbt_index_offset_size_in_bytes: u32,
        84 sbt_index_offset_stride_in_bytes: u32,
        88 primitive_index_offset: u32,
        92 transform_format: OptixTransformFormat,
        96 opacity_micromap: OptixBuildInputOpacityMicromap,
        144 displacement_micromap: [u64; 12],
    }

    OptixBuildInputCurveArray: size 80 align 8 {
        0 curve_type: OptixPrimitiveType,
        4 num_primitives: u32,
        8 vertex_buffers: *const CUdeviceptr,
        16 num_vertices: u32,
        20 vertex_stride_in_bytes: u32,
        24 width_buffers: *const CUdeviceptr,
        32 width_stride_in_bytes: u32,
        40 normal_buffers: *const CUdeviceptr,
        48 normal_stride_in_bytes: u32,
        56 index_buffer: CUdeviceptr,
        64 index_stride_in_bytes: u32,
        68 flag: u32,
        72 primitive_index_offset: u32,
        76 endcap_flags: u32,
    }

    OptixBuildInputSphereArray: size 72 align 8 {
        0 vertex_buffers: *const CUdeviceptr,
        8 vertex_stride_in_bytes: u32,
        12 num_vertices: u32,
        16 radius_buffers: *const CUdeviceptr,
        24 radius_stride_in_bytes: u32,
        28 single_radius: i32,
        32 flags: *const u32,
        40 num_sbt_records: u32,
        48 sbt_index_offset_buffer: CUdeviceptr,
        56 sbt_index_offset_size_in_bytes: u32,
        60 sbt_index_offset_stride_in_bytes: u32,
        64 primitive_index_offset: u32,
    }

    OptixBuildInputCustomPrimitiveArray: size 56 align 8 {
        0 aabb_buffers: *const CUdeviceptr,
        8 num_primitives: u32,
        12 stride_in_bytes: u32,
        16 flags: *const u32,
        24 num_sbt_records: u32,
        32 sbt_index_offset_buffer: CUdeviceptr,
        40 sbt_index_offset_size_in_bytes: u32,
        44 sbt_index_offset_stride_in_bytes: u32,
        48 primitive_index_offset: u32,
    }

    OptixBuildInputInstanceArray: size 16 align 8 {
        0 instances: CUdeviceptr,
        8 num_instances: u32,
        12 instance_stride: u32,
    }

    OptixBuildInput: size 1032 align 8 {
        0 kind: OptixBuildInputType,
        8 input: OptixBuildInputUnion,
    }

    OptixAabb: size 24 align 4 {
        0 min: [f32; 3],
        12 max: [f32; 3],
    }

    OptixInstance: size 80 align 8 {
        0 transform: [f32; 12],
        48 instance_id: u32,
        52 sbt_offset: u32,
        56 visibility_mask: u32,
        60 flags: u32,
        64 traversable_handle: OptixTraversableHandle,
        72 pad: [u32; 2],
    }

    OptixMotionOptions: size 12 align 4 {
        0 num_keys: u16,
        2 flags: OptixMotionFlags,
        4 time_begin: f32,
        8 time_end: f32,
    }

    OptixAccelBuildOptions: size 20 align 4 {
        0 build_flags: u32,
        4 operation: OptixBuildOperation,
        8 motion_options: OptixMotionOptions,
    }

    OptixAccelBufferSizes: size 24 align 8 {
        0 output_size_in_bytes: usize,
        8 temp_size_in_bytes: usize,
        16 temp_update_size_in_bytes: usize,
    }

    OptixAccelEmitDesc: size 16 align 8 {
        0 result: CUdeviceptr,
        8 kind: OptixAccelPropertyType,
    }
}

/// The input of a build. [`OptixBuildInputType`] tells which member counts.
#[repr(C)]
#[derive(Clone, Copy)]
pub union OptixBuildInputUnion {
    pub triangle_array: OptixBuildInputTriangleArray,
    pub curve_array: OptixBuildInputCurveArray,
    pub sphere_array: OptixBuildInputSphereArray,
    pub custom_primitive_array: OptixBuildInputCustomPrimitiveArray,
    pub instance_array: OptixBuildInputInstanceArray,
    pub pad: [u8; 1024],
}

const _: () = assert!(size_of::<OptixBuildInputUnion>() == 1024);
const _: () = assert!(align_of::<OptixBuildInputUnion>() == 8);

impl core::fmt::Debug for OptixBuildInputUnion {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("OptixBuildInputUnion")
    }
}

// SAFETY: 32-bit and 64-bit numbers without padding between or after them: 48 + 4 * 4 + 8 + 8 bytes make 80.
unsafe impl bytemuck::Zeroable for OptixInstance {}
// SAFETY: as above; every bit pattern is a value.
unsafe impl bytemuck::Pod for OptixInstance {}
