//! The path tracer's host side: command line, scene, rendering, report.
//!
//! A library, so that the comparison of CPU and GPU in `tests/` renders the same scene.

pub mod args;
pub mod image_file;
pub mod knot;
pub mod mesh;
pub mod plot;
pub mod progress;
pub mod render;
pub mod scene;

pub use path_tracer_shaders as shaders;
