//! What can go wrong on the host. Each message says what was asked, what is wrong, and what to do.

use optix_device_rs::host::MemoryError;

/// An error of a host call.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Geometry that no acceleration structure can be built from.
    #[error("{0}")]
    Geometry(#[from] crate::scene::GeometryError),
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
    NoOptix(#[source] crate::optix::driver::Error),
    /// An error of the CUDA or OptiX driver.
    #[error("{0}")]
    Driver(#[from] crate::optix::driver::Error),
    /// An error of a copy to or from device memory.
    #[error("device memory: {0}")]
    Memory(#[from] MemoryError),
    /// The CPU executor could not build an acceleration structure.
    #[error("acceleration structure: {0}")]
    Build(#[from] crate::cpu::kernel::BuildError),
}
