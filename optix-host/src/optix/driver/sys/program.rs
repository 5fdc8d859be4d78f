//! Program groups (guide 6.6).

use core::ffi::c_char;

use super::{OptixModule, OptixPayloadType};

abi_consts! {
    /// Which member of [`OptixProgramGroupPrograms`] counts.
    OptixProgramGroupKind: u32 {
        RAYGEN = 9249,
        MISS = 9250,
        EXCEPTION = 9251,
        HITGROUP = 9252,
        CALLABLES = 9253,
    }
}

abi_structs! {
    /// A ray-generation, miss or exception program.
    OptixProgramGroupSingleModule: size 16 align 8 {
        0 module: OptixModule,
        8 entry_function_name: *const c_char,
    }

    OptixProgramGroupHitgroup: size 48 align 8 {
        0 module_ch: OptixModule,
        8 entry_function_name_ch: *const c_char,
        16 module_ah: OptixModule,
        24 entry_function_name_ah: *const c_char,
        32 module_is: OptixModule,
        40 entry_function_name_is: *const c_char,
    }

    OptixProgramGroupCallables: size 32 align 8 {
        0 module_dc: OptixModule,
        8 entry_function_name_dc: *const c_char,
        16 module_cc: OptixModule,
        24 entry_function_name_cc: *const c_char,
    }

    OptixProgramGroupDesc: size 56 align 8 {
        0 kind: OptixProgramGroupKind,
        4 flags: u32,
        8 programs: OptixProgramGroupPrograms,
    }

    OptixProgramGroupOptions: size 8 align 8 {
        0 payload_type: *const OptixPayloadType,
    }

    /// Stack use of one program group in bytes: continuation stack of each program kind, direct stack of callables.
    OptixStackSizes: size 28 align 4 {
        0 css_rg: u32,
        4 css_ms: u32,
        8 css_ch: u32,
        12 css_ah: u32,
        16 css_is: u32,
        20 css_cc: u32,
        24 dss_dc: u32,
    }
}

/// The programs of a group; which member counts is told by [`OptixProgramGroupKind`]. The raygen, miss and exception
/// members of the C union are the same structure and share `single` here.
#[repr(C)]
#[derive(Clone, Copy)]
pub union OptixProgramGroupPrograms {
    pub single: OptixProgramGroupSingleModule,
    pub hitgroup: OptixProgramGroupHitgroup,
    pub callables: OptixProgramGroupCallables,
}

const _: () = assert!(size_of::<OptixProgramGroupPrograms>() == 48);
const _: () = assert!(align_of::<OptixProgramGroupPrograms>() == 8);

impl core::fmt::Debug for OptixProgramGroupPrograms {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("OptixProgramGroupPrograms")
    }
}
