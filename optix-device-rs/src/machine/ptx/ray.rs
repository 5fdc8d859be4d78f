//! The current ray (guide 13.5).

use super::Cx;
use core::arch::asm;
use glam::Vec3;

impl Cx {
    #[inline(always)]
    pub fn world_ray_origin(&self) -> Vec3 {
        get_vec3!("_optix_get_world_ray_origin")
    }
    #[inline(always)]
    pub fn world_ray_direction(&self) -> Vec3 {
        get_vec3!("_optix_get_world_ray_direction")
    }
    #[inline(always)]
    pub fn object_ray_origin(&self) -> Vec3 {
        get_vec3!("_optix_get_object_ray_origin")
    }
    #[inline(always)]
    pub fn object_ray_direction(&self) -> Vec3 {
        get_vec3!("_optix_get_object_ray_direction")
    }
    #[inline(always)]
    pub fn ray_tmin(&self) -> f32 {
        get_f32!("_optix_get_ray_tmin")
    }
    #[inline(always)]
    pub fn ray_tmax(&self) -> f32 {
        get_f32!("_optix_get_ray_tmax")
    }
    /// `ray_tmax` in an intersection program: changes while it reports, so it is not pure.
    #[inline(always)]
    pub fn interval_end(&self) -> f32 {
        let value: f32;
        // SAFETY: a query of the running program.
        unsafe {
            asm!(
                "{{ .reg .f32 f; call (f), _optix_get_ray_tmax, (); mov.b32 {v}, f; }}",
                v = out(reg32) value,
                options(nostack, preserves_flags)
            )
        };
        value
    }
    #[inline(always)]
    pub fn ray_time(&self) -> f32 {
        get_f32!("_optix_get_ray_time")
    }
    #[inline(always)]
    pub fn ray_flags(&self) -> u32 {
        get_u32!("_optix_get_ray_flags")
    }
    #[inline(always)]
    pub fn ray_mask(&self) -> u32 {
        get_u32!("_optix_get_ray_visibility_mask")
    }
}
