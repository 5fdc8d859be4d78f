//! Geometry, instance and ray flags, and what they say together about any-hit programs and face culling.

use crate::geometry::GeometryFlags;
use crate::scene::InstanceFlags;

/// The bits of `OptixRayFlags` (guide 13.2).
pub mod ray_flags {
    pub const NONE: u32 = 0;
    pub const DISABLE_ANYHIT: u32 = 1;
    pub const ENFORCE_ANYHIT: u32 = 2;
    pub const TERMINATE_ON_FIRST_HIT: u32 = 4;
    pub const DISABLE_CLOSESTHIT: u32 = 8;
    pub const CULL_BACK_FACING_TRIANGLES: u32 = 16;
    pub const CULL_FRONT_FACING_TRIANGLES: u32 = 32;
    pub const CULL_DISABLED_ANYHIT: u32 = 64;
    pub const CULL_ENFORCED_ANYHIT: u32 = 128;
}

/// What the flags say about a primitive, before it is intersected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The ray does not see the primitive.
    Cull,
    /// A hit counts without an any-hit call.
    Opaque,
    /// The any-hit program decides.
    AnyHit,
}

/// The any-hit decision (guide 5.1, 5.4, 13.2): the geometry flag, overridden by the instance, tested by the ray's
/// two cull flags, and overridden by the ray.
pub fn any_hit_verdict(geometry: GeometryFlags, instance: InstanceFlags, ray: u32) -> Verdict {
    let enabled = if instance.contains(InstanceFlags::DISABLE_ANYHIT) {
        false
    } else {
        instance.contains(InstanceFlags::ENFORCE_ANYHIT) || !geometry.contains(GeometryFlags::DISABLE_ANYHIT)
    };
    let culled = if enabled { ray_flags::CULL_ENFORCED_ANYHIT } else { ray_flags::CULL_DISABLED_ANYHIT };
    if ray & culled != 0 {
        return Verdict::Cull;
    }
    let enabled = (enabled || ray & ray_flags::ENFORCE_ANYHIT != 0) && ray & ray_flags::DISABLE_ANYHIT == 0;
    if enabled { Verdict::AnyHit } else { Verdict::Opaque }
}

/// Whether the ray's face culling drops a triangle seen from its front (`front`, after any flip).
pub fn face_culled(geometry: GeometryFlags, instance: InstanceFlags, ray: u32, front: bool) -> bool {
    let side = if front { ray_flags::CULL_FRONT_FACING_TRIANGLES } else { ray_flags::CULL_BACK_FACING_TRIANGLES };
    ray & side != 0
        && !geometry.contains(GeometryFlags::DISABLE_TRIANGLE_FACE_CULLING)
        && !instance.contains(InstanceFlags::DISABLE_TRIANGLE_FACE_CULLING)
}
