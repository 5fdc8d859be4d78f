//! The kinds of primitives that leaves hold, a file or folder each: the build input and its checks, how it is packed, what a ray
//! does in a leaf, and what programs ask of a primitive afterwards.
//!
//! A new kind is a file that implements [`Leaves`], a variant of [`Primitives`], and a constructor of [`Gas`](super::Gas). What
//! becomes of a hit is not its business: it offers what it finds to the [`Sink`](super::candidate::Sink).

pub mod custom;
pub mod triangle;

use super::bvh::Bvh;
use super::simd::Simd;
use super::trace::AtGas;
use crate::geometry::GasInputs;
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
    pub fn build(inputs: GasInputs) -> (Bvh, Self) {
        match inputs {
            GasInputs::Triangles(inputs) => {
                let (bvh, triangles) = Triangles::build(inputs);
                (bvh, Self::Triangles(triangles))
            }
            GasInputs::Custom(inputs) => {
                let (bvh, custom) = Custom::build(inputs);
                (bvh, Self::Custom(custom))
            }
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

/// What a ray does in the leaves of a structure.
pub trait Leaves {
    /// Tests what the leaf with this payload holds, at depths of at most `limit`. Gives the new limit: negative infinity if the ray
    /// has ended.
    fn visit<S: Simd>(&self, simd: S, ray: &mut AtGas<'_, '_>, leaf: u32, limit: f32) -> f32;

    /// Tests all primitives of a structure that has no nodes.
    fn visit_all<S: Simd>(&self, simd: S, ray: &mut AtGas<'_, '_>, limit: f32);
}
