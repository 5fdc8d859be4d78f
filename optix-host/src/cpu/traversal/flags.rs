//! Geometry, instance and ray flags, and what they say together about any-hit programs and face culling.

use crate::geometry::GeometryFlags;
use crate::scene::InstanceFlags;

/// The bits of `OptixRayFlags` (guide 13.2) that traversal looks at, as the device crate has them.
pub mod ray_flags {
    use optix_device_rs::prelude::{AnyHitMode, CullFaces, RayFlags};

    pub const NONE: u32 = RayFlags::NONE.bits();
    pub const DISABLE_ANYHIT: u32 = AnyHitMode::Disable as u32;
    pub const ENFORCE_ANYHIT: u32 = AnyHitMode::Enforce as u32;
    pub const CULL_DISABLED_ANYHIT: u32 = AnyHitMode::CullDisabled as u32;
    pub const CULL_ENFORCED_ANYHIT: u32 = AnyHitMode::CullEnforced as u32;
    pub const TERMINATE_ON_FIRST_HIT: u32 = RayFlags::NONE.terminate_on_first_hit().bits();
    pub const CULL_BACK_FACING_TRIANGLES: u32 = CullFaces::Back as u32;
    pub const CULL_FRONT_FACING_TRIANGLES: u32 = CullFaces::Front as u32;
    /// Those about any-hit programs, which exclude each other.
    pub const ANYHIT: u32 = DISABLE_ANYHIT | ENFORCE_ANYHIT | CULL_DISABLED_ANYHIT | CULL_ENFORCED_ANYHIT;
    /// Those about faces, which exclude each other.
    pub const CULL_FACES: u32 = CULL_BACK_FACING_TRIANGLES | CULL_FRONT_FACING_TRIANGLES;
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
