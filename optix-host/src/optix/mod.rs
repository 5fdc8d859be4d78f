//! NVIDIA OptiX as a backend, loaded at run time.

mod backend;
#[cfg(feature = "cust")]
pub mod cust;
pub mod driver;
mod feedback;

pub(crate) use backend::OptixBackend;
