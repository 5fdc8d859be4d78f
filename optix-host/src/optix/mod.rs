//! NVIDIA OptiX as a backend, loaded at run time.

mod backend;
#[allow(missing_docs)]
pub mod driver;

pub(crate) use backend::OptixBackend;
