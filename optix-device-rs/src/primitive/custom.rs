//! Custom primitives: boxes with an intersection program of the user's, which reports what hits carry (guide 13.4).

use super::{Attributes, Primitive, PrimitiveType};
use crate::check::FitsEverywhere;
use core::ops::RangeInclusive;

/// Primitives whose intersection program the user writes.
#[derive(Clone, Copy, Debug)]
pub enum Custom {}

impl Primitive for Custom {
    const TYPE: PrimitiveType = PrimitiveType::Custom;
    const OPTIX_TYPE: u32 = 0x2500;
    const HIT_KINDS: RangeInclusive<u8> = 0..=127;
    const HAS_INTERSECTION_PROGRAM: bool = true;
    const QUERIES: &'static [&'static str] = &[];
    type Hits<Reported: Attributes> = Reported;
    type IntersectionProgram<Program> = Program;
    type ProgramOfBuiltIn<Program> = FitsEverywhere;
}

// What custom primitives carry is `attributes()`, which is of all kinds.
device_functions! {}

/// Attributes that an intersection program may report: those of custom primitives, by `#[derive(Attributes)]`.
///
/// Hits of built-in primitives, as [`Triangles`](super::Triangles), are not among them. Closest-hit and any-hit programs of
/// such hits ask for vertices and faces, which custom primitives do not have (guide 13.9).
///
/// # Safety
/// No trait of built-in primitives, as [`OnTriangles`](super::OnTriangles), is implemented for them.
#[diagnostic::on_unimplemented(
    message = "an intersection program can't report hits that carry `{Self}`",
    label = "expected attributes of a custom primitive, a struct with `#[derive(Attributes)]`",
    note = "`Triangles` are hits on built-in triangles, whose vertices a closest-hit program may ask for: declare attributes of your own, `#[derive(Clone, Copy, Attributes)] pub struct BallHit {{ pub uv: Vec2 }}`, and name them in the context, `&Intersection<PathTracer, BallHit>`"
)]
pub unsafe trait Reported: Attributes {}
