//! The kinds of primitives that leaves hold, a file or folder each: how they are packed, what a ray does in a leaf, and what
//! programs ask of a primitive afterwards.
//!
//! A new kind is a file that implements [`Leaves`], and a variant of [`Primitives`]. What becomes of a hit is not its business: it
//! submits what it finds to the [`HitSink`](super::candidate::HitSink).

pub mod custom;
pub mod triangle;

use super::bvh::Bvh;
use super::candidate::HitSink;
use super::program::Programs;
use super::simd::Simd;
use crate::geometry::{BuildInput, BuildInputs, PrimitiveArray};
use custom::Custom;
use triangle::Triangles;

/// The primitives of a structure, of one kind.
#[derive(Debug)]
pub enum Primitives {
    Triangles(Triangles),
    Custom(Custom),
}

impl Primitives {
    /// Packs primitives, with a hierarchy over them.
    pub fn build(inputs: BuildInputs) -> (Bvh, Self) {
        fn packed<L: Leaves>(inputs: Vec<BuildInput<L::Array>>, kind: fn(L) -> Primitives) -> (Bvh, Primitives) {
            let (bvh, leaves) = L::build(inputs);
            (bvh, kind(leaves))
        }
        match inputs {
            BuildInputs::Triangles(inputs) => packed(inputs, Self::Triangles),
            BuildInputs::Custom(inputs) => packed(inputs, Self::Custom),
        }
    }

    /// Heap bytes, with those of the inputs, which are kept for the accessors.
    pub fn memory_bytes(&self) -> usize {
        match self {
            Self::Triangles(triangles) => triangles.memory_bytes(),
            Self::Custom(custom) => custom.memory_bytes(),
        }
    }
}

/// A ray in the space of a structure of primitives.
pub struct LeafRay<'t, 'a> {
    pub sink: HitSink<'t, 'a>,
    pub programs: &'t mut dyn Programs,
    /// Whether differences of coordinates may overflow.
    pub far: bool,
}

/// Primitives of one kind, packed in the leaves of a structure.
pub trait Leaves: Sized {
    /// What they are built of.
    type Array: PrimitiveArray;

    /// Packs primitives, with a hierarchy over them.
    fn build(inputs: Vec<BuildInput<Self::Array>>) -> (Bvh, Self);

    /// Heap bytes, with those of the inputs.
    fn memory_bytes(&self) -> usize;

    /// Tests what the leaf with this payload holds, at depths of at most `limit`. Gives the new limit: negative infinity if the ray
    /// has ended.
    fn visit<S: Simd>(&self, simd: S, ray: &mut LeafRay<'_, '_>, leaf: u32, limit: f32) -> f32;

    /// Tests all primitives of a structure that has no nodes.
    fn visit_all<S: Simd>(&self, simd: S, ray: &mut LeafRay<'_, '_>, limit: f32);
}
