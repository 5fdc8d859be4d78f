//! A leaf: two triangles, of which an any-hit program cuts a leaf's outline.

use crate::{PathTracer, RadianceAtClosestHit, RadianceFromClosestHit, surface};
use optix_device_rs::prelude::*;

/// A leaf on a parallelogram of two triangles, `p00 p10 p11` and `p00 p11 p01`.
#[derive(Clone, Copy, SbtRecord)]
#[repr(C)]
pub struct Leaf {
    /// Share of light that it reflects, per colour.
    pub albedo: Vec3,
}

/// Where on the parallelogram a hit is, both coordinates from 0 to 1.
fn place(primitive: u32, barycentrics: Vec2) -> Vec2 {
    let Vec2 { x: u, y: v } = barycentrics;
    if primitive == 0 { Vec2::new(u + v, v) } else { Vec2::new(u, u + v) }
}

/// Whether there is leaf: a lens that narrows to both ends, with a serrated edge and a stalk.
fn is_leaf(at: Vec2) -> bool {
    let across = (at.y - 0.5).abs();
    let teeth = 0.02 * ((at.x * 16.0) - (at.x * 16.0).floor());
    let along = (at.x - 0.12) / 0.88;
    let width = 1.6 * along * (1.0 - along) * (1.15 - 0.5 * along) - teeth;
    across < width || (across < 0.012 && at.x < 0.2)
}

/// Lets rays pass beside the leaf. It reads no payload, so it serves every ray type.
#[anyhit]
pub fn cut_out(hit: &AnyHit<PathTracer, Triangles>) -> Decision {
    if is_leaf(place(hit.primitive_index(), hit.barycentrics())) { Decision::Accept } else { Decision::Ignore }
}

/// Shades the leaf, with its veins.
#[closesthit]
pub fn leaf(
    hit: &ClosestHit<PathTracer, Triangles>,
    record: &Leaf,
    ray: RadianceAtClosestHit,
) -> RadianceFromClosestHit {
    let at = place(hit.primitive_index(), hit.barycentrics());
    let across = (at.y - 0.5).abs();
    let stripe = (at.x - 0.6 * across) * 9.0;
    let vein = across < 0.012 || stripe - stripe.floor() < 0.09;
    let albedo = if vein { record.albedo * 1.6 } else { record.albedo };
    let point = hit.surface_point();
    surface::diffuse(hit, &point, point.normal, albedo, ray)
}
