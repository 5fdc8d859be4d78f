//! NVIDIA OptiX as a backend, loaded at run time.

mod backend;
pub mod driver;
mod feedback;

pub(crate) use backend::OptixBackend;
#[cfg(feature = "cust")]
pub(crate) use backend::OptixMemory;

/// How OptiX is set up.
#[derive(Clone, Debug, Default)]
pub struct OptixOptions {
    /// Validation mode (guide 4.3): slow, reports what is otherwise undefined.
    pub validation: bool,
}
