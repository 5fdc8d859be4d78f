//! What can go wrong on the host: an enum for each area, whose variants name what is wrong by fields. Each says what is wrong
//! and where, and in a second line what to do about it.

mod build;
mod driver;
mod geometry;
mod instance;
mod launch;
mod pipeline;
mod reference;
mod scene;
mod texture;
mod words;

pub use build::BuildError;
pub use driver::{CudaFailure, DriverError, LogMessage, OptixFailure};
pub use geometry::GeometryError;
pub use instance::InstanceError;
pub use launch::LaunchError;
pub use pipeline::{LayoutDifference, PipelineError};
pub use reference::ReferenceError;
pub use scene::SceneError;
pub use texture::TextureError;

use optix_device_rs::host::{MemoryError, Rule};
use std::borrow::Cow;
use std::fmt;

/// The result of host calls.
pub type Result<T, E = Error> = core::result::Result<T, E>;

/// An error of a host call.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Geometry that no acceleration structure can be built from.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// A texture that can't be made.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// A scene that does not fit together.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A pipeline that can't be built for this scene or device.
    #[error("pipeline {pipeline}: {error}")]
    Pipeline {
        /// The pipeline's name.
        pipeline: &'static str,
        /// What is wrong.
        error: PipelineError,
    },
    /// A launch that can't begin.
    #[error("launch of pipeline {pipeline}: {error}")]
    Launch {
        /// The pipeline's name.
        pipeline: &'static str,
        /// What is wrong.
        error: LaunchError,
    },
    /// A program that went wrong on the CPU.
    #[error("program {program} at launch index {index:?}: {what}{}\n  what to do: {}", section(*rule), rule.remedy())]
    Program {
        /// The entry name.
        program: String,
        /// The launch index.
        index: [u32; 3],
        /// The rule that it broke.
        rule: Rule,
        /// How it broke it.
        what: String,
    },
    /// No OptiX on this machine.
    #[error("OptiX is not available: {0}")]
    NoOptix(#[source] DriverError),
    /// An error of the CUDA or OptiX driver.
    #[error(transparent)]
    Driver(#[from] DriverError),
    /// An error of a copy to or from device memory.
    #[error("device memory: {0}")]
    Memory(#[from] MemoryError),
    /// An acceleration structure that can't be built.
    #[error("acceleration structure: {0}")]
    Build(#[from] BuildError),
}

impl Error {
    /// What to do about it. Those of drivers say it in their own fields.
    pub fn remedy(&self) -> Option<Cow<'static, str>> {
        match self {
            Self::Geometry(error) => Some(error.remedy()),
            Self::Texture(error) => Some(error.remedy()),
            Self::Scene(error) => Some(error.remedy()),
            Self::Pipeline { error, .. } => Some(error.remedy()),
            Self::Launch { error, .. } => Some(error.remedy()),
            Self::Program { rule, .. } => Some(rule.remedy().into()),
            Self::Build(error) => Some(error.remedy()),
            Self::NoOptix(_) | Self::Driver(_) | Self::Memory(_) => None,
        }
    }
}

/// Where the guide has a rule, for messages.
fn section(rule: Rule) -> String {
    match rule.guide() {
        "" => String::new(),
        guide => format!(" (guide {guide})"),
    }
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
            "4 positions without indices are not whole triangles\n  \
             what to do: give a multiple of 3 positions, or give indices"
        );
        let error: Box<dyn std::error::Error> = MemoryError::Length { given: 2, buffer: 3 }.into();
        assert!(format!("{error:?}").starts_with("2 elements were given for a buffer of 3\n"), "{error:?}");
    }
}
