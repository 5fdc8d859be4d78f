//! What can be wrong with the input of an acceleration structure.

use super::GeometryError;
use super::words::{Words, errors};

/// Why an acceleration structure was not built. Geometries and instances are counted from 0, in the order given.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub enum BuildError {
    /// Geometry that no structure can be built of.
    Input {
        /// Which geometry.
        input: usize,
        /// What is wrong with it.
        error: GeometryError,
    },
    /// More than a structure takes.
    TooMany {
        /// Of what.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: usize,
    },
    /// A number of an instance that is too large.
    Exceeds28Bits {
        /// Which instance.
        instance: usize,
        /// Which of its numbers.
        field: &'static str,
        /// The number.
        value: u32,
    },
    /// Record offsets on a way down the graph whose sum is too large.
    SbtOffsetSum {
        /// Which instance.
        instance: usize,
        /// Its record offset.
        offset: u32,
        /// The sum with the greatest below it.
        sum: u32,
    },
    /// A transform with an element that is NaN or infinite.
    NonFiniteTransform {
        /// Which instance.
        instance: usize,
        /// Its transform, row by row.
        transform: [f32; 12],
    },
    /// A transform without an inverse.
    SingularTransform {
        /// Which instance.
        instance: usize,
        /// Its transform, row by row.
        transform: [f32; 12],
    },
    /// Both of the flags that say whether any-hit programs run.
    AnyHitFlags {
        /// Which instance.
        instance: usize,
    },
    /// A graph that is deeper than rays go.
    TooDeep {
        /// Which instance.
        instance: usize,
        /// How many structures would be on the way down from here.
        depth: usize,
        /// How many there may be.
        limit: usize,
    },
}

impl BuildError {
    fn words(&self) -> Words {
        let (problem, remedy): (String, &str) = match self {
            Self::Input { input, error } => {
                return (format!("geometry {input} of the GAS: {}", error.problem()), error.remedy());
            }
            Self::TooMany { what, count, limit } => (
                format!("there are {count} {what}, but an acceleration structure has {limit} at most (guide 12)"),
                "split it over several, and put those into an IAS",
            ),
            Self::Exceeds28Bits { instance, field, value } => (
                format!("instance {instance}: its {field} is {value:#x}, which is more than 28 bits (guide 5.4)"),
                "give it a smaller one",
            ),
            Self::SbtOffsetSum { instance, offset, sum } => (
                format!(
                    "instance {instance}: its SBT offset {offset} and those below it add up to {sum}, which is more than 28 \
                     bits (guide 5.4)"
                ),
                "use fewer records, or fewer levels of instances with an offset",
            ),
            Self::NonFiniteTransform { instance, transform } => (
                format!("instance {instance}: its transform {transform:?} is not finite"),
                "give all of its elements finite values",
            ),
            Self::SingularTransform { instance, transform } => (
                format!("instance {instance}: its transform {transform:?} can't be inverted"),
                "give it one that can; to hide an instance use visibility mask 0",
            ),
            Self::AnyHitFlags { instance } => (
                format!(
                    "instance {instance}: its flags DISABLE_ANYHIT and ENFORCE_ANYHIT exclude each other (guide 5.4)"
                ),
                "leave one out",
            ),
            Self::TooDeep { instance, depth, limit } => (
                format!(
                    "instance {instance}: the graph below it would be {depth} structures deep, more than {limit} (guide 12)"
                ),
                "put instances of instances into one IAS, with the product of their transforms",
            ),
        };
        (problem, remedy.into())
    }
}

errors!(BuildError);
