//! The traversal and intersection kernel of the CPU executor.
//!
//! It has OptiX's semantics (guide §5, §7.3, §13) and knows nothing of shaders: it calls them through [`Programs`].
//!
//! | module | what |
//! | --- | --- |
//! | `gas`, `ias` | structures and their inputs, checked |
//! | `binary`, `collapse`, `bvh` | the 8-wide hierarchy: built by obvhs, collapsed at least cost, laid out |
//! | `ray`, `simd`, `triangle` | the arithmetic: box and triangle tests, their error bounds |
//! | `trace`, `stack` | traversal |
//! | `candidate`, `state` | what becomes of what a test finds: interval, culling, any-hit, acceptance |
//! | `program`, `path` | what programs are told, and report |

mod aabb;
mod binary;
mod bvh;
mod candidate;
mod collapse;
mod flags;
mod gas;
mod ias;
mod path;
mod program;
mod ray;
mod simd;
mod stack;
mod state;
mod trace;
mod triangle;

#[cfg(test)]
mod tests;

pub use crate::affine::Affine;
pub use crate::error::BuildError;
pub use aabb::Aabb;
pub use flags::{GeometryFlags, Verdict, any_hit_verdict, ray_flags};
pub use gas::{AabbInput, Gas, SbtMapping, TriangleInput};
pub use ias::{Accel, Ias, Instance, MAX_GRAPH_DEPTH, Placed};
pub use path::InstancePath;
pub use program::{AnyHit, Candidate, Hit, Programs, Reporter, Site};
pub use ray::{Ray, RayQuery};
pub use trace::{BACK_FACE, FRONT_FACE, trace, trace_portable};
