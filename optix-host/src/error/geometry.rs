//! What can be wrong with geometry.

use super::words::{Words, errors};
use crate::limits::MAX_PRIMITIVES;
use glam::Vec3;

/// What is wrong with geometry. Vertices and primitives are counted from 0.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub enum GeometryError {
    /// No primitive.
    Empty {
        /// Which kind of geometry.
        what: &'static str,
    },
    /// Not a multiple of three.
    PartialTriangle {
        /// How many positions there are.
        count: usize,
    },
    /// An index without a vertex.
    IndexOutOfRange {
        /// Which triangle.
        triangle: usize,
        /// The index.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// NaN or infinity.
    NonFiniteVertex {
        /// Which vertex.
        vertex: usize,
        /// Its value.
        value: Vec3,
    },
    /// A box that is not one.
    BadBox {
        /// Which box.
        index: usize,
        /// Its least corner.
        min: Vec3,
        /// Its greatest corner.
        max: Vec3,
    },
    /// More than an acceleration structure takes.
    TooMany {
        /// How many there are.
        count: usize,
    },
}

impl GeometryError {
    fn words(&self) -> Words {
        let (problem, remedy): (String, &str) = match *self {
            Self::Empty { what } => {
                (format!("{what} has no primitives"), "give it at least one, or leave the geometry out")
            }
            Self::PartialTriangle { count } => (
                format!("{count} positions without indices are not whole triangles"),
                "give a multiple of 3 positions, or give indices",
            ),
            Self::IndexOutOfRange { triangle, index, vertices } => (
                format!("triangle {triangle} has index {index}, but there are {vertices} vertices"),
                "correct the indices, which count the vertices from 0",
            ),
            Self::NonFiniteVertex { vertex, value } => {
                (format!("vertex {vertex} is not finite: {value}"), "give all of its coordinates finite values")
            }
            Self::BadBox { index, min, max } => (
                format!("box {index} is not finite with min <= max: {min} to {max}"),
                "correct its corners; a box without end reaches from f32::MIN to f32::MAX",
            ),
            Self::TooMany { count } => (
                format!(
                    "{count} primitives are more than the 2^{} of an acceleration structure (guide 12)",
                    MAX_PRIMITIVES.ilog2()
                ),
                "split the geometry over several structures, and put those into an IAS",
            ),
        };
        (problem, remedy.into())
    }
}

errors!(GeometryError);
