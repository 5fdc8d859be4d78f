//! The launch index and the program's record (guide 13.1, 13.8).

use super::Cx;
use core::arch::asm;
use glam::UVec3;

impl Cx {
    #[inline(always)]
    pub fn record(&self) -> *const u8 {
        let address: u64;
        // SAFETY: pure query.
        unsafe {
            asm!(
                "call ({a}), _optix_get_sbt_data_ptr_64, ();",
                a = out(reg64) address,
                options(pure, nomem, nostack, preserves_flags)
            )
        };
        address as *const u8
    }

    #[inline(always)]
    pub fn launch_index(&self) -> UVec3 {
        UVec3::new(
            get_u32!("_optix_get_launch_index_x"),
            get_u32!("_optix_get_launch_index_y"),
            get_u32!("_optix_get_launch_index_z"),
        )
    }

    #[inline(always)]
    pub fn launch_dimensions(&self) -> UVec3 {
        UVec3::new(
            get_u32!("_optix_get_launch_dimension_x"),
            get_u32!("_optix_get_launch_dimension_y"),
            get_u32!("_optix_get_launch_dimension_z"),
        )
    }
}
