//! Loads that a GPU is timed with, for device programs by several code generators.

mod generator;
mod load;
pub mod loads;

pub use generator::{Generator, generators};
pub use load::Load;
