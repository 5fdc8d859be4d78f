//! What can be wrong with geometry.

use crate::limits::MAX_PRIMITIVES;
use glam::Vec3;
use std::fmt;

/// What is wrong with geometry.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GeometryError {
    /// No primitive.
    #[error("{what} has no primitives")]
    Empty {
        /// Which kind of geometry.
        what: &'static str,
    },
    /// Not a multiple of three.
    #[error("{count} positions without indices are not whole triangles: give a multiple of 3, or indices")]
    PartialTriangle {
        /// How many there are.
        count: usize,
    },
    /// An index without a vertex.
    #[error("triangle {triangle} has index {index}, but there are {vertices} vertices")]
    IndexOutOfRange {
        /// Which triangle.
        triangle: usize,
        /// The index.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// NaN or infinity.
    #[error("vertex {vertex} is not finite: {value}")]
    NonFiniteVertex {
        /// Which vertex.
        vertex: usize,
        /// Its value.
        value: Vec3,
    },
    /// A box that is not one.
    #[error(
        "box {index} is not finite with min <= max: {min} to {max}; one without end reaches from f32::MIN to f32::MAX"
    )]
    BadBox {
        /// Which box.
        index: usize,
        /// Its least corner.
        min: Vec3,
        /// Its greatest corner.
        max: Vec3,
    },
    /// More than an acceleration structure takes.
    #[error("{count} primitives are more than the 2^{} of an acceleration structure (guide 12)", MAX_PRIMITIVES.ilog2())]
    TooMany {
        /// How many there are.
        count: usize,
    },
}

/// As [`Display`](fmt::Display): what `main` prints of an error that it returns, and `unwrap` of one that it meets.
impl fmt::Debug for GeometryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}
