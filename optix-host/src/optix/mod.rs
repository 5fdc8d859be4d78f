//! NVIDIA OptiX as a backend, loaded at run time.

mod backend;
pub mod driver;

pub(crate) use backend::OptixBackend;
