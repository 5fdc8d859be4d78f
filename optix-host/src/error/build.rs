//! What can be wrong with the input of an acceleration structure.

use super::words::{Words, errors};
use super::{GeometryError, InstanceError};

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
    /// An instance that no structure can be built of.
    Instance {
        /// Which instance.
        instance: usize,
        /// What is wrong with it.
        error: InstanceError,
    },
}

impl BuildError {
    fn words(&self) -> Words {
        let (problem, remedy): (String, &str) = match self {
            Self::Input { input, error } => {
                return (format!("geometry {input} of the GAS: {}", error.problem()), error.remedy());
            }
            Self::Instance { instance, error } => {
                return (format!("instance {instance}: {}", error.problem()), error.remedy());
            }
            Self::TooMany { what, count, limit } => (
                format!("there are {count} {what}, but an acceleration structure has {limit} at most (guide 12)"),
                "split it over several, and put those into an IAS",
            ),
        };
        (problem, remedy.into())
    }
}

errors!(BuildError);
