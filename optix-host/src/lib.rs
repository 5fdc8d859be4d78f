//! What an application sees of an OptiX pipeline written in Rust: scenes, materials, pipelines, launches, on the GPU
//! through NVIDIA's driver or on the CPU through an embedded executor with the same semantics.
//!
//! Data flows one way: a pipeline type (declared in a shader crate by `pipeline!`) and a [`Scene`] give a [`Pipeline`]
//! specialised to both, which launches. Nothing is written twice: record layouts, SBT offsets, payload types, stack sizes
//! and flags follow from the types and the scene.
//!
//! "Guide" is the [NVIDIA OptiX 9.0 Programming Guide](https://raytracing-docs.nvidia.com/optix9/guide/index.html), with the
//! number of the chapter or section.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(missing_docs)]

mod affine;
mod backend;
pub mod build;
pub mod cpu;
#[cfg(feature = "cust")]
#[cfg_attr(docsrs, doc(cfg(feature = "cust")))]
pub mod cust;
mod device;
mod error;
mod features;
pub mod geometry;
mod launch;
mod limits;
pub mod optix;
pub mod pipeline;
mod plan;
pub mod sbt;
pub mod scene;
pub mod texture;

pub use build::Scene;
pub use device::{BackendKind, Device};
pub use error::{
    Error, LaunchError, LayoutDifference, PipelineError, ReferenceError, Result, SceneError, TextureError,
};
pub use geometry::{Aabb, CustomPrimitives, TriangleMesh};
pub use glam;
pub use launch::Launch;
pub use optix::OptixOptions;
pub use optix_device_rs::host::{Buffer, Buffer2d, InstanceTable, MemoryError, Rule, Texture, TriangleTable, World};
pub use optix_report as report;
pub use pipeline::{Pipeline, PipelineBuilder};
pub use scene::{Accel, Geometry, Instance, Material};
pub use texture::{AddressMode, FilterMode};

/// The PTX of a shader crate that the build script compiled with `optix_toolchain::shaders`; the crate is named as in
/// Rust paths. Empty where no device compiler was found.
///
/// ```text
/// let ptx = optix_host::ptx!(path_tracer_shaders);
/// ```
#[macro_export]
macro_rules! ptx {
    ($crate_name:ident) => {
        ::core::include_str!(::core::env!(
            ::core::concat!("OPTIX_PTX_", ::core::stringify!($crate_name)),
            "this crate's build.rs does not call optix_toolchain::shaders for that shader crate"
        ))
    };
}
