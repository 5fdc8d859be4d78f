//! What can be wrong with the input of an acceleration structure.

use super::GeometryError;
use thiserror::Error;

/// Why an acceleration structure was not built. Inputs are counted from 0 in the order given.
#[derive(Clone, Debug, PartialEq, Error)]
#[expect(missing_docs, reason = "the messages say what the variants and their fields are")]
#[non_exhaustive]
pub enum BuildError {
    #[error("geometry {input} of the GAS: {error}")]
    Input {
        input: usize,
        #[source]
        error: GeometryError,
    },
    #[error("{count} {what} in one acceleration structure; at most {limit} are possible, split it over several")]
    TooMany { what: &'static str, count: usize, limit: usize },
    #[error("instance {instance}: {field} is {value:#x}, but it has only 28 bits (guide 5.4)")]
    Exceeds28Bits { instance: usize, field: &'static str, value: u32 },
    #[error(
        "instance {instance}: its SBT offset {offset} and those below it add up to {sum}, which exceeds 28 bits \
         (guide 5.4)"
    )]
    SbtOffsetSum { instance: usize, offset: u32, sum: u32 },
    #[error("instance {instance}: transform {transform:?} has an element that is not finite")]
    NonFiniteTransform { instance: usize, transform: [f32; 12] },
    #[error("instance {instance}: transform {transform:?} is singular; to hide an instance use visibility mask 0")]
    SingularTransform { instance: usize, transform: [f32; 12] },
    #[error("instance {instance}: flags DISABLE_ANYHIT and ENFORCE_ANYHIT exclude each other; clear one")]
    AnyHitFlags { instance: usize },
    #[error("instance {instance}: the graph below it would be {depth} traversables deep; at most {limit} (guide 12)")]
    TooDeep { instance: usize, depth: usize, limit: usize },
}
