//! Structures of the CPU executor, and how rays traverse them.
//!
//! It has OptiX's semantics (guide 5, 7.3, 13) and knows nothing of shaders: it calls them through [`Programs`].
//!
//! | module | what |
//! | --- | --- |
//! | `gas`, `ias` | structures and their inputs, checked |
//! | `primitive` | the kinds of primitives, a file or folder each |
//! | `bvh` | the 8-wide hierarchy: a binary one built by obvhs, collapsed at least cost, laid out |
//! | `ray`, `simd`, `primitive::triangle::{intersect, simd}` | the arithmetic: box and triangle tests, their error bounds |
//! | `trace`, `stack` | traversal |
//! | `candidate`, `state` | what becomes of what a test finds: interval, culling, any-hit, acceptance |
//! | `program`, `path` | what programs are told, and report |

mod bvh;
mod candidate;
mod flags;
mod gas;
mod ias;
mod path;
mod primitive;
mod program;
mod ray;
mod simd;
mod stack;
mod state;
mod trace;

#[cfg(test)]
mod tests;

pub use crate::affine::Affine;
pub use crate::error::BuildError;
pub use crate::limits::MAX_GRAPH_DEPTH;
pub use bvh::Aabb;
pub use flags::{Verdict, any_hit_verdict, ray_flags};
pub use gas::Gas;
pub use ias::{Accel, BuiltInstance, Ias, Instance};
pub use path::InstancePath;
pub use primitive::triangle::{BACK_FACE, FRONT_FACE};
pub use program::{AnyHit, Candidate, Hit, PrimitiveContext, Programs, Reporter};
pub use ray::{Ray, RayQuery};
pub use trace::{trace, trace_portable};
