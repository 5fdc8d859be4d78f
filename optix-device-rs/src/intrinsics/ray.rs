//! The current ray (guide 13.5).

use crate::ray::RayFlags;
#[cfg(target_arch = "nvptx64")]
use core::arch::asm;
use glam::Vec3;

device_functions! {
    in ray else HasRay {
        /// Origin in world space, as passed to trace.
        "optixGetWorldRayOrigin"
        fn world_ray_origin(&self) -> Vec3 {
            ptx { get_vec3!("_optix_get_world_ray_origin") }
            host { self.frame().ray.origin }
        }

        /// Direction in world space, as passed to trace.
        "optixGetWorldRayDirection"
        fn world_ray_direction(&self) -> Vec3 {
            ptx { get_vec3!("_optix_get_world_ray_direction") }
            host { self.frame().ray.direction }
        }

        /// Least `t`, as passed to trace.
        "optixGetRayTmin"
        fn ray_tmin(&self) -> f32 {
            ptx { get_f32!("_optix_get_ray_tmin") }
            host { self.frame().ray.tmin }
        }

        /// The end of the ray's interval. In an intersection program the nearest `t` accepted so far, else the `tmax` passed to
        /// trace: it shrinks while the program reports. In an any-hit program the candidate's `t`, in a closest-hit program the
        /// hit's, in a miss program the `tmax` passed to trace.
        "optixGetRayTmax"
        fn ray_tmax(&self) -> f32 {
            ptx {
                if Self::REPORTS {
                    let value: f32;
                    // SAFETY: a query of the running program. It is not pure, since the value changes with each report.
                    unsafe {
                        asm!(
                            "{{ .reg .f32 f; call (f), _optix_get_ray_tmax, (); mov.b32 {v}, f; }}",
                            v = out(reg32) value,
                            options(nostack, preserves_flags)
                        )
                    };
                    value
                } else {
                    get_f32!("_optix_get_ray_tmax")
                }
            }
            host { if Self::REPORTS { self.frame().executor.interval_end() } else { self.frame().ray.tmax } }
        }

        /// Time, as passed to trace; 0 in a pipeline without motion.
        "optixGetRayTime"
        fn ray_time(&self) -> f32 {
            ptx { get_f32!("_optix_get_ray_time") }
            host { self.frame().ray.time }
        }

        /// Flags, as passed to trace.
        "optixGetRayFlags"
        fn ray_flags(&self) -> RayFlags {
            ptx {
                let bits = get_u32!("_optix_get_ray_flags");
                // SAFETY: they are those of a `Ray`.
                unsafe { RayFlags::from_bits(bits) }
            }
            host { self.frame().ray.flags }
        }

        /// Visibility mask, as passed to trace.
        "optixGetRayVisibilityMask"
        fn ray_visibility_mask(&self) -> u8 {
            ptx { get_u32!("_optix_get_ray_visibility_mask") as u8 }
            host { self.frame().ray.mask }
        }
    }

    in object_ray else HasObjectRay {
        /// Ray origin in object space (guide 13.5).
        "optixGetObjectRayOrigin"
        fn object_ray_origin(&self) -> Vec3 {
            ptx { get_vec3!("_optix_get_object_ray_origin") }
            host { self.frame().object_ray.0 }
        }

        /// Ray direction in object space, scaled as the transform does: `t` means the same in both spaces.
        "optixGetObjectRayDirection"
        fn object_ray_direction(&self) -> Vec3 {
            ptx { get_vec3!("_optix_get_object_ray_direction") }
            host { self.frame().object_ray.1 }
        }
    }
}
