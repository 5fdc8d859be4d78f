//! Hit kinds, and what any program may learn from one (guide 13.7).

use crate::intrinsics;
use crate::primitive::PrimitiveType;
use crate::words::Words;

/// What was hit: 0 to 127 is what an intersection program reported, the others are of built-in primitives (guide 13.7).
///
/// A program that has one learns from it what the hit's own programs do, wherever it runs: so a closest-hit program may
/// leave it in the payload.
///
/// ```
/// use optix_device_rs::prelude::*;
/// assert_eq!(HitKind::TRIANGLE_BACK_FACE.primitive_type(), PrimitiveType::Triangle);
/// assert_eq!(HitKind::TRIANGLE_BACK_FACE.face(), Some(Face::Back));
/// assert_eq!(HitKind::new(3).unwrap().face(), None);
/// assert_eq!(HitKind::new(200), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct HitKind(u8);

/// Which side of a triangle a ray came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    /// Vertices run counter-clockwise as seen from the ray's origin.
    Front,
    /// Clockwise.
    Back,
}

impl HitKind {
    /// A kind by its number; none if no hit can have it.
    #[inline(always)]
    pub const fn new(kind: u8) -> Option<Self> {
        match PrimitiveType::of_hit_kind(kind) {
            Some(_) => Some(Self(kind)),
            None => None,
        }
    }

    /// A hit's own.
    #[inline(always)]
    pub(crate) const fn of_number(kind: u8) -> Self {
        Self(kind)
    }

    /// The number: for a custom primitive what its intersection program reported.
    #[inline(always)]
    pub const fn get(self) -> u8 {
        self.0
    }

    /// The kind of primitive (`optixGetPrimitiveType`).
    #[inline(always)]
    pub fn primitive_type(self) -> PrimitiveType {
        intrinsics::primitive_type_of(self.0)
    }

    /// Which side was hit (`optixIsFrontFaceHit`, `optixIsBackFaceHit`); none for a custom primitive, which has no sides
    /// that OptiX knows of.
    #[inline(always)]
    pub fn face(self) -> Option<Face> {
        (self.primitive_type() != PrimitiveType::Custom).then(|| self.side())
    }

    /// Which side of a built-in primitive was hit.
    #[inline(always)]
    pub(crate) fn side(self) -> Face {
        if intrinsics::is_back_face(self.0) { Face::Back } else { Face::Front }
    }
}

impl Words for HitKind {
    const COUNT: usize = 1;
    #[inline(always)]
    fn store(self, words: &mut [u32]) {
        self.0.store(words);
    }
    #[inline(always)]
    unsafe fn load(words: &[u32]) -> Self {
        // SAFETY: the words are of a hit kind that was stored.
        Self(unsafe { u8::load(words) })
    }
}
