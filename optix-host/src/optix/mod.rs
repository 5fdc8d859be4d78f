//! NVIDIA OptiX as a backend, loaded at run time.

mod backend;
pub mod driver;
mod feedback;

pub(crate) use backend::OptixBackend;
