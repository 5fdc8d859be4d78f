//! What can go wrong on the host. Each message says what was asked, what is wrong, and what to do.

mod build;
mod driver;
mod geometry;

pub use build::BuildError;
pub use driver::{CudaFailure, DriverError, LogMessage, OptixFailure};
pub use geometry::GeometryError;

use optix_device_rs::host::MemoryError;
use std::fmt;

/// The result of host calls.
pub type Result<T, E = Error> = core::result::Result<T, E>;

/// An error of a host call.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Geometry that no acceleration structure can be built from.
    #[error("{0}")]
    Geometry(#[from] GeometryError),
    /// A scene that does not fit together.
    #[error("{0}")]
    Scene(String),
    /// A pipeline that can't be built for this scene or device.
    #[error("pipeline {pipeline}: {what}")]
    Pipeline {
        /// The pipeline's name.
        pipeline: &'static str,
        /// What is wrong, and what to do.
        what: String,
    },
    /// A launch that can't begin.
    #[error("launch of pipeline {pipeline}: {what}")]
    Launch {
        /// The pipeline's name.
        pipeline: &'static str,
        /// What is wrong, and what to do.
        what: String,
    },
    /// A program that went wrong on the CPU.
    #[error("program {program} at launch index {index:?}: {what}")]
    Program {
        /// The entry name.
        program: String,
        /// The launch index.
        index: [u32; 3],
        /// What it did.
        what: String,
    },
    /// No OptiX on this machine.
    #[error("OptiX is not available: {0}")]
    NoOptix(#[source] DriverError),
    /// An error of the CUDA or OptiX driver.
    #[error("{0}")]
    Driver(#[from] DriverError),
    /// An error of a copy to or from device memory.
    #[error("device memory: {0}")]
    Memory(#[from] MemoryError),
    /// The CPU executor could not build an acceleration structure.
    #[error("acceleration structure: {0}")]
    Build(#[from] BuildError),
}

/// As [`Display`](fmt::Display): what `main` prints of an error that it returns, and `unwrap` of one that it meets.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_main_prints_is_the_message() {
        let error = Error::from(GeometryError::PartialTriangle { count: 4 });
        assert_eq!(format!("{error:?}"), error.to_string());
        let boxed: Box<dyn std::error::Error> = error.into();
        assert_eq!(
            format!("{boxed:?}"),
            "4 positions without indices are not whole triangles: give a multiple of 3, or indices"
        );
        let error: Box<dyn std::error::Error> = MemoryError("the copy failed".into()).into();
        assert_eq!(format!("{error:?}"), "the copy failed");
    }
}
