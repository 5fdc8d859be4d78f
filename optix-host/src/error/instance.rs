//! What can be wrong with an instance.

use super::words::{Words, errors};
use crate::limits::INSTANCE_BITS;

/// What is wrong with an instance.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub enum InstanceError {
    /// An id that is too large.
    Id {
        /// The id.
        id: u32,
    },
    /// A record offset that is too large.
    RecordOffset {
        /// The offset.
        offset: u32,
    },
    /// Record offsets on a way down the graph whose sum is too large.
    RecordOffsetSum {
        /// The instance's own.
        offset: u32,
        /// The sum with the greatest below it.
        sum: u32,
    },
    /// Flags that exclude each other.
    Flags {
        /// Their names.
        flags: [&'static str; 2],
    },
    /// A transform with an element that is NaN or infinite.
    NonFiniteTransform {
        /// The transform, row by row.
        transform: [f32; 12],
    },
    /// A transform without an inverse.
    SingularTransform {
        /// The transform, row by row.
        transform: [f32; 12],
    },
    /// A graph that is deeper than rays go.
    TooDeep {
        /// How many structures would be on the way down, with the one that holds the instance.
        depth: usize,
        /// How many there may be.
        limit: usize,
    },
}

impl InstanceError {
    fn words(&self) -> Words {
        let (problem, remedy): (String, &str) = match *self {
            Self::Id { id } => (
                format!("its id {id} is more than {INSTANCE_BITS} bits (guide 5.4)"),
                "give it a smaller id, and keep what it stands for in a buffer that programs index by it",
            ),
            Self::RecordOffset { offset } => (
                format!(
                    "its records begin at number {offset} of the table, which is more than {INSTANCE_BITS} bits (guide 5.4)"
                ),
                "use fewer materials per GAS; GASes with the same list of materials share their records",
            ),
            Self::RecordOffsetSum { offset, sum } => (
                format!(
                    "its record offset {offset} and those below it add up to {sum}, which is more than {INSTANCE_BITS} bits \
                     (guide 5.4)"
                ),
                "use fewer records, or fewer levels of instances with an offset",
            ),
            Self::Flags { flags: [a, b] } => {
                (format!("its flags {a} and {b} exclude each other (guide 5.4)"), "leave one out")
            }
            Self::NonFiniteTransform { transform } => {
                (format!("its transform {transform:?} is not finite"), "give all of its elements finite values")
            }
            Self::SingularTransform { transform } => (
                format!("its transform {transform:?} can't be inverted, so rays can't be taken to its space"),
                "give it one that can; an instance that shrinks to nothing, or to a plane, is left out from there on",
            ),
            Self::TooDeep { depth, limit } => (
                format!(
                    "the graph with it would be {depth} structures deep, but rays go down {limit} at most (guide 12)"
                ),
                "put instances of instances into one IAS, with the product of their transforms",
            ),
        };
        (problem, remedy.into())
    }
}

errors!(InstanceError);
