//! The function table of ABI 105: 52 pointers in slot order.

use core::ffi::{c_char, c_uint, c_void};

use super::*;

/// The exported entry point of `libnvoptix.so.1` (guide 3.6): ABI version, three reserved arguments that are zero,
/// the table to fill and its size in bytes.
pub type QueryFunctionTable = unsafe extern "C" fn(
    abi_id: i32,
    num_options: c_uint,
    option_keys: *mut c_void,
    option_values: *mut *const c_void,
    function_table: *mut c_void,
    size_of_table: usize,
) -> OptixResult;

/// A slot that this crate does not call.
type Unused = Option<unsafe extern "C" fn()>;

/// Declares the table. A slot with a signature becomes an `Option` of a function pointer and a method that calls it;
/// where the driver left the slot empty, the method answers [`OptixResult::ENTRY_SYMBOL_NOT_FOUND`].
macro_rules! function_table {
    ($($slot:literal $name:ident $([$kind:ident])? $(($($arg:ident: $ty:ty),*))?;)*) => {
        /// The driver's functions, in slot order.
        ///
        /// The methods only forward: the contract of each is NVIDIA's API reference for the function of that name
        /// (`device_context_create` is `optixDeviceContextCreate`).
        #[repr(C)]
        #[derive(Clone, Copy)]
        pub struct FunctionTable {
            $($name: function_table!(@field $([$kind])? $(($($arg: $ty),*))?),)*
        }

        impl FunctionTable {
            /// Slots of the table.
            pub const SLOTS: usize = [$($slot),*].len();
        }

        const _: () = {
            assert!(size_of::<FunctionTable>() == FunctionTable::SLOTS * size_of::<*const c_void>());
            $(assert!(core::mem::offset_of!(FunctionTable, $name) == $slot * size_of::<*const c_void>());)*
        };

        $(function_table!(@method $name $([$kind])? $(($($arg: $ty),*))?);)*
    };
    (@field) => { Unused };
    (@field [text]) => { Option<unsafe extern "C" fn(OptixResult) -> *const c_char> };
    (@field ($($arg:ident: $ty:ty),*)) => {
        Option<unsafe extern "C" fn($($arg: $ty),*) -> OptixResult>
    };
    (@method $name:ident) => {};
    (@method $name:ident [text]) => {
        impl FunctionTable {
            /// The driver's static text for a result, where the driver has the function.
            pub fn $name(&self, result: OptixResult) -> Option<&'static core::ffi::CStr> {
                // SAFETY: the slot was filled by the driver for this ABI; the function takes any integer.
                let text = self.$name.map(|function| unsafe { function(result) })?;
                // SAFETY: not null, and the API reference says that it is a NUL-terminated string in static memory.
                (!text.is_null()).then(|| unsafe { core::ffi::CStr::from_ptr(text) })
            }
        }
    };
    (@method $name:ident ($($arg:ident: $ty:ty),*)) => {
        impl FunctionTable {
            /// # Safety
            /// As the API reference says of this function: every pointer is valid for what it is used for, every
            /// handle is live, and the CUDA context is current where a stream is taken.
            #[allow(clippy::too_many_arguments)]
            pub unsafe fn $name(&self, $($arg: $ty),*) -> OptixResult {
                match self.$name {
                    // SAFETY: the slot was filled by the driver for this ABI, so the signature is the driver's; the
                    // caller promises the arguments.
                    Some(function) => unsafe { function($($arg),*) },
                    None => OptixResult::ENTRY_SYMBOL_NOT_FOUND,
                }
            }
        }
    };
}

function_table! {
    0 get_error_name [text];
    1 get_error_string [text];
    2 device_context_create(
        from: CUcontext,
        options: *const OptixDeviceContextOptions,
        context: *mut OptixDeviceContext
    );
    3 device_context_destroy(context: OptixDeviceContext);
    4 device_context_get_property(
        context: OptixDeviceContext,
        property: OptixDeviceProperty,
        value: *mut c_void,
        size: usize
    );
    5 device_context_set_log_callback(
        context: OptixDeviceContext,
        callback: OptixLogCallback,
        data: *mut c_void,
        level: u32
    );
    6 device_context_set_cache_enabled(context: OptixDeviceContext, enabled: i32);
    7 device_context_set_cache_location(context: OptixDeviceContext, location: *const c_char);
    8 device_context_set_cache_database_sizes(context: OptixDeviceContext, low: usize, high: usize);
    9 device_context_get_cache_enabled(context: OptixDeviceContext, enabled: *mut i32);
    10 device_context_get_cache_location(context: OptixDeviceContext, location: *mut c_char, size: usize);
    11 device_context_get_cache_database_sizes(
        context: OptixDeviceContext,
        low: *mut usize,
        high: *mut usize
    );
    12 module_create(
        context: OptixDeviceContext,
        module_options: *const OptixModuleCompileOptions,
        pipeline_options: *const OptixPipelineCompileOptions,
        input: *const c_char,
        input_size: usize,
        log: *mut c_char,
        log_size: *mut usize,
        module: *mut OptixModule
    );
    13 module_create_with_tasks;
    14 module_get_compilation_state;
    15 module_destroy(module: OptixModule);
    16 builtin_is_module_get(
        context: OptixDeviceContext,
        module_options: *const OptixModuleCompileOptions,
        pipeline_options: *const OptixPipelineCompileOptions,
        builtin_options: *const OptixBuiltinISOptions,
        module: *mut OptixModule
    );
    17 task_execute;
    18 program_group_create(
        context: OptixDeviceContext,
        descriptions: *const OptixProgramGroupDesc,
        count: u32,
        options: *const OptixProgramGroupOptions,
        log: *mut c_char,
        log_size: *mut usize,
        groups: *mut OptixProgramGroup
    );
    19 program_group_destroy(group: OptixProgramGroup);
    20 program_group_get_stack_size(
        group: OptixProgramGroup,
        sizes: *mut OptixStackSizes,
        pipeline: OptixPipeline
    );
    21 pipeline_create(
        context: OptixDeviceContext,
        pipeline_options: *const OptixPipelineCompileOptions,
        link_options: *const OptixPipelineLinkOptions,
        groups: *const OptixProgramGroup,
        count: u32,
        log: *mut c_char,
        log_size: *mut usize,
        pipeline: *mut OptixPipeline
    );
    22 pipeline_destroy(pipeline: OptixPipeline);
    23 pipeline_set_stack_size(
        pipeline: OptixPipeline,
        direct_from_traversal: u32,
        direct_from_state: u32,
        continuation: u32,
        max_traversable_graph_depth: u32
    );
    24 accel_compute_memory_usage(
        context: OptixDeviceContext,
        options: *const OptixAccelBuildOptions,
        inputs: *const OptixBuildInput,
        count: u32,
        sizes: *mut OptixAccelBufferSizes
    );
    25 accel_build(
        context: OptixDeviceContext,
        stream: CUstream,
        options: *const OptixAccelBuildOptions,
        inputs: *const OptixBuildInput,
        count: u32,
        temp: CUdeviceptr,
        temp_size: usize,
        output: CUdeviceptr,
        output_size: usize,
        handle: *mut OptixTraversableHandle,
        emitted: *const OptixAccelEmitDesc,
        emitted_count: u32
    );
    26 accel_get_relocation_info;
    27 check_relocation_compatibility;
    28 accel_relocate;
    29 accel_compact(
        context: OptixDeviceContext,
        stream: CUstream,
        input: OptixTraversableHandle,
        output: CUdeviceptr,
        output_size: usize,
        handle: *mut OptixTraversableHandle
    );
    30 accel_emit_property(
        context: OptixDeviceContext,
        stream: CUstream,
        handle: OptixTraversableHandle,
        emitted: *const OptixAccelEmitDesc
    );
    31 convert_pointer_to_traversable_handle(
        context: OptixDeviceContext,
        pointer: CUdeviceptr,
        kind: OptixTraversableType,
        handle: *mut OptixTraversableHandle
    );
    32 opacity_micromap_array_compute_memory_usage;
    33 opacity_micromap_array_build;
    34 opacity_micromap_array_get_relocation_info;
    35 opacity_micromap_array_relocate;
    36 displacement_micromap_array_compute_memory_usage;
    37 displacement_micromap_array_build;
    38 cluster_accel_compute_memory_usage;
    39 cluster_accel_build;
    40 sbt_record_pack_header(group: OptixProgramGroup, header: *mut c_void);
    41 launch(
        pipeline: OptixPipeline,
        stream: CUstream,
        params: CUdeviceptr,
        params_size: usize,
        sbt: *const OptixShaderBindingTable,
        width: u32,
        height: u32,
        depth: u32
    );
    42 coop_vec_matrix_convert;
    43 coop_vec_matrix_compute_size;
    44 denoiser_create;
    45 denoiser_destroy;
    46 denoiser_compute_memory_resources;
    47 denoiser_setup;
    48 denoiser_invoke;
    49 denoiser_compute_intensity;
    50 denoiser_compute_average_color;
    51 denoiser_create_with_user_model;
}
