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
    /// More vertices than 32 bits can number.
    TooManyVertices {
        /// How many there are.
        count: usize,
    },
    /// More or fewer material or record numbers than primitives.
    RecordNumbers {
        /// How many primitives there are.
        primitives: usize,
        /// For how many it is said which material they have.
        numbers: usize,
    },
    /// A primitive with the number of no material.
    NoSuchRecord {
        /// Which primitive.
        primitive: usize,
        /// Its number.
        number: u32,
        /// How many materials, and so records, there are.
        records: usize,
    },
    /// No record at all.
    NoRecord,
    /// Primitive indices that programs can't be told.
    PrimitiveIndexOverflow {
        /// The offset.
        offset: u32,
        /// How many primitives there are.
        primitives: usize,
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
            Self::TooManyVertices { count } => (
                format!("{count} vertices are more than indices of 32 bits can name"),
                "split the geometry over several",
            ),
            Self::RecordNumbers { primitives, numbers } => (
                format!("it has {primitives} primitives, but {numbers} material numbers"),
                "give `with_each` one number for each primitive",
            ),
            Self::NoSuchRecord { primitive, number, records } => (
                format!("primitive {primitive} has material number {number}, but there are {records} materials"),
                "number the materials from 0, in the order in which `with_each` is given them",
            ),
            Self::NoRecord => ("it has no hit-group record".into(), "give it at least one"),
            Self::PrimitiveIndexOverflow { offset, primitives } => (
                format!("{primitives} primitives with indices from {offset} on do not fit 32 bits"),
                "give a smaller primitive index offset",
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
