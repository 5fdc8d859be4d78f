//! Geometry as both machines take it, and the only checks of what users give (guide 5.1).
//!
//! A kind of primitive is a file: the builder that users see, and a checked array of primitives, which nothing but its check
//! makes. The kind is registered here, as a [`GasPrimitive`] and as a variant of [`BuildInputs`], which is what a machine builds
//! a GAS of.

mod custom;
mod input;
mod records;
mod triangles;

pub use crate::error::GeometryError;
pub use custom::{Aabb, CustomPrimitiveArray, CustomPrimitives};
pub use input::{BuildInput, GasLimits};
pub use records::{GeometryFlags, Records};
pub use triangles::{TriangleArray, TriangleMesh};

use crate::error::BuildError;
use optix_device_rs::primitive::{Custom, Primitive, PrimitiveType, Triangles};

/// A checked array of primitives of one kind. Read-only: what was checked stays as it was.
pub trait PrimitiveArray: Send + Sync + 'static {
    /// The kind, for messages.
    const NAME: &'static str;

    /// How many primitives there are.
    fn len(&self) -> usize;

    /// Whether there are none.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// At how many times they are given: 1 for those that don't move.
    fn motion_keys(&self) -> usize {
        1
    }
}

/// A kind of primitive that GASes are built of: what a device program calls it, with the array that a host gives.
pub trait GasPrimitive: Primitive {
    /// Checked primitives of this kind.
    type Array: PrimitiveArray;

    /// Build inputs of this kind.
    fn inputs(inputs: Vec<BuildInput<Self::Array>>) -> BuildInputs;
}

/// Something that users give as geometry.
pub trait IntoGeometry {
    /// Its kind.
    type Kind: GasPrimitive;

    /// Checks and copies it.
    fn check(self) -> Result<<Self::Kind as GasPrimitive>::Array, GeometryError>;
}

/// The build inputs of a GAS, which are all of one kind (guide 5.1).
#[derive(Clone, Debug)]
pub enum BuildInputs {
    /// Triangles.
    Triangles(Vec<BuildInput<TriangleArray>>),
    /// Custom primitives.
    Custom(Vec<BuildInput<CustomPrimitiveArray>>),
}

impl GasPrimitive for Triangles {
    type Array = TriangleArray;

    fn inputs(inputs: Vec<BuildInput<TriangleArray>>) -> BuildInputs {
        BuildInputs::Triangles(inputs)
    }
}

impl GasPrimitive for Custom {
    type Array = CustomPrimitiveArray;

    fn inputs(inputs: Vec<BuildInput<CustomPrimitiveArray>>) -> BuildInputs {
        BuildInputs::Custom(inputs)
    }
}

impl From<Vec<BuildInput<TriangleArray>>> for BuildInputs {
    fn from(inputs: Vec<BuildInput<TriangleArray>>) -> Self {
        Self::Triangles(inputs)
    }
}

impl From<Vec<BuildInput<CustomPrimitiveArray>>> for BuildInputs {
    fn from(inputs: Vec<BuildInput<CustomPrimitiveArray>>) -> Self {
        Self::Custom(inputs)
    }
}

impl BuildInputs {
    /// Which kind it is.
    pub fn kind(&self) -> PrimitiveType {
        match self {
            Self::Triangles(_) => Triangles::TYPE,
            Self::Custom(_) => Custom::TYPE,
        }
    }

    /// The most motion keys of an input.
    pub fn motion_keys(&self) -> usize {
        fn most<A: PrimitiveArray>(inputs: &[BuildInput<A>]) -> usize {
            inputs.iter().map(|input| input.primitives().motion_keys()).max().unwrap_or(1)
        }
        match self {
            Self::Triangles(inputs) => most(inputs),
            Self::Custom(inputs) => most(inputs),
        }
    }

    /// Whether a GAS may have as many primitives and records as these.
    pub(crate) fn check(&self, limits: GasLimits) -> Result<(), BuildError> {
        match self {
            Self::Triangles(inputs) => limits.check(inputs),
            Self::Custom(inputs) => limits.check(inputs),
        }
    }
}
