//! Geometry as both machines take it, and the only checks of what users give (guide 5.1).
//!
//! A kind of primitive is a file: the builder that users see, and a checked array of primitives, which nothing but its check
//! makes. It is registered here, as a variant of [`BuildInputs`] and an arm of `of_any_kind`.

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
use optix_device_rs::primitive::{Primitive, PrimitiveType};

/// A checked array of primitives of one kind. Read-only: what was checked stays as it was.
pub trait PrimitiveArray: Sized + Send + Sync + 'static {
    /// The kind.
    type Primitive: GasPrimitive<Array = Self>;

    /// The kind, for messages.
    const NAME: &'static str;

    /// Build inputs of this kind.
    fn inputs(inputs: Vec<BuildInput<Self>>) -> BuildInputs;

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
    type Array: PrimitiveArray<Primitive = Self>;
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

/// Does the same with build inputs of any kind.
macro_rules! of_any_kind {
    ($inputs:expr, $of_kind:ident => $body:expr) => {
        match $inputs {
            $crate::geometry::BuildInputs::Triangles($of_kind) => $body,
            $crate::geometry::BuildInputs::Custom($of_kind) => $body,
        }
    };
}
pub(crate) use of_any_kind;

impl<A: PrimitiveArray> From<Vec<BuildInput<A>>> for BuildInputs {
    fn from(inputs: Vec<BuildInput<A>>) -> Self {
        A::inputs(inputs)
    }
}

impl BuildInputs {
    /// Which kind it is.
    pub fn kind(&self) -> PrimitiveType {
        fn kind<A: PrimitiveArray>(_: &[BuildInput<A>]) -> PrimitiveType {
            A::Primitive::TYPE
        }
        of_any_kind!(self, inputs => kind(inputs))
    }

    /// The most motion keys of an input.
    pub fn motion_keys(&self) -> usize {
        of_any_kind!(self, inputs => inputs.iter().map(|input| input.primitives().motion_keys()).max().unwrap_or(1))
    }

    /// Whether a GAS may have as many primitives and records as these.
    pub(crate) fn check(&self, limits: GasLimits) -> Result<(), BuildError> {
        of_any_kind!(self, inputs => limits.check(inputs))
    }
}
