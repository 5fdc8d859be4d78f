//! What can be wrong with the input of an acceleration structure.

use thiserror::Error;

/// Why an acceleration structure was not built. Inputs are counted from 0 in the order given.
#[derive(Clone, Debug, PartialEq, Error)]
#[expect(missing_docs, reason = "the messages say what the variants and their fields are")]
#[non_exhaustive]
pub enum BuildError {
    #[error(
        "build input {input}: corner {corner} of triangle {triangle} has vertex index {index}, but there are only \
         {vertices} vertices (0 to {last}); correct the index buffer",
        last = .vertices.wrapping_sub(1)
    )]
    IndexOutOfRange { input: usize, triangle: usize, corner: usize, index: u32, vertices: usize },
    #[error("build input {input}: without an index buffer the {vertices} vertices must be a multiple of 3")]
    IncompleteTriangle { input: usize, vertices: usize },
    #[error("build input {input}: vertex {vertex} is {position:?}; every coordinate must be finite")]
    NonFiniteVertex { input: usize, vertex: usize, position: [f32; 3] },
    #[error("build input {input}: box {primitive} runs from {min:?} to {max:?}; every coordinate must be finite")]
    NonFiniteBox { input: usize, primitive: usize, min: [f32; 3], max: [f32; 3] },
    #[error("build input {input} has no SBT record; give one set of geometry flags per record, at least one")]
    NoSbtRecord { input: usize },
    #[error("build input {input} has {records} SBT records, so it needs one record index per primitive (guide 5.1)")]
    NoPerPrimitiveIndex { input: usize, records: usize },
    #[error("build input {input} has {primitives} primitives but {indices} per-primitive SBT indices")]
    PerPrimitiveLength { input: usize, primitives: usize, indices: usize },
    #[error("build input {input}: primitive {primitive} has SBT index {index}, but the input has {records} records")]
    SbtIndexOutOfRange { input: usize, primitive: usize, index: u32, records: usize },
    #[error("build input {input}: primitive index offset {offset} plus {primitives} primitives exceeds 32 bits")]
    PrimitiveIndexOverflow { input: usize, offset: u32, primitives: usize },
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
