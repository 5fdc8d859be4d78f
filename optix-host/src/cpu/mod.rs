//! The embedded executor: OptiX's semantics on the CPU.
//!
//! A launch runs its ray-generation program for every launch index, on all threads of rayon's current pool; a trace call
//! walks the acceleration structure in [`traversal`] and calls the programs that the shader binding table names, as the
//! device does. Results do not depend on the number of threads.

mod backend;
mod executor;
mod memory;
mod texture;
#[allow(missing_docs)]
pub mod traversal;

pub(crate) use backend::CpuBackend;
