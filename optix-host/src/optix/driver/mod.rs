//! The OptiX driver: its raw ABI in [`sys`], and owners over it that free what they made and can't outlive what they use.
//!
//! Everything loads at run time: a program with this module starts on a machine without an NVIDIA driver, where
//! [`Context::new`] says what is missing. The ABI version is agreed on with the driver (see [`sys::ABIS`]).
//!
//! - [`Context`]: a GPU, one stream, the driver's log. Work runs in the order it was asked for.
//! - [`DeviceBuffer`]: device memory. Copies come after everything asked for before.
//! - [`Texture`]: texels, and the object that programs look them up by.
//! - [`Accel`], [`Transform`]: traversables, which keep their memory and their children alive.
//! - [`Module`] → [`ProgramGroup`] → [`Pipeline`]: programs, each keeping what it was made from.
//! - [`ShaderBindingTable`] and [`Pipeline::launch`]: a [`Launch`] holds what it uses until it is done.
//!
//! Owners may be cloned, sent and shared between threads. Dropping one never panics; what frees device memory waits for
//! the stream first. Arguments are checked before the driver sees them, as far as chapters 5 to 12 of the guide set a
//! rule that the host can check. What the host can't check, such as the contents of device memory and of launch
//! parameters, is the caller's promise to `unsafe` functions.

mod accel;
mod buffer;
mod compile_log;
mod context;
mod cuda;
mod event;
mod launch;
mod library;
mod limits;
mod log;
mod module;
mod module_options;
mod options;
mod payload;
mod pipeline;
mod program;
pub(crate) mod remedy;
mod sbt;
pub mod stack;
pub mod sys;
mod texture;
mod transform;

use std::any::Any;
use std::sync::Arc;

pub use crate::error::{CudaFailure, DriverError as Error, LogMessage, OptixFailure};
pub use accel::{Accel, AccelOptions, Instance, Motion, Preference, Traversable};
pub use buffer::DeviceBuffer;
pub use context::{Context, ContextOptions, DiskCache};
pub use cuda::{DeviceInfo, devices, ordinal_of};
pub use launch::{Launch, LaunchArgs};
pub use limits::Limits;
pub use log::LogLevel;
pub use module::{BuiltinIntersection, Module};
pub use module_options::{BoundValue, DebugLevel, ModuleOptions, OptimizationLevel};
pub use options::{Exceptions, PipelineOptions, PrimitiveKinds, TraversableGraph};
pub use payload::{PayloadSemantics, PayloadType};
pub use pipeline::{LinkOptions, Pipeline};
pub use program::{Entry, Intersection, ProgramGroup, Programs};
pub use sbt::{SbtSection, SbtSections, ShaderBindingTable};
pub use texture::Texture;
pub use transform::Transform;

/// Things to keep alive: buffers, acceleration structures, program groups.
pub type KeepAlive = Vec<Arc<dyn Any + Send + Sync>>;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn owners_may_be_sent_and_shared() {
        fn check<T: Send + Sync>() {}
        check::<Context>();
        check::<DeviceBuffer>();
        check::<Accel>();
        check::<Transform>();
        check::<Module>();
        check::<ProgramGroup>();
        check::<Pipeline>();
        check::<ShaderBindingTable>();
        check::<Launch>();
        check::<Error>();
    }
}
